// SPDX-License-Identifier: Apache-2.0
#include "experiment/splitter.h"

#include <algorithm>
#include <cmath>

#include "dcnn/data/pose_noise.h"

namespace dcnn {
namespace {

constexpr double kValidationGapSeconds = 1.0;
constexpr std::uint64_t kPoseStream = 200;  // of random numbers, apart from those of the training

std::string signal_of(const Json& configuration) {
  return configuration.value("noise", Json::object()).value("on", std::string());
}

Index validation_rows(const Recording& recording, double share) {
  return static_cast<Index>(std::lround(share * static_cast<double>(recording.samples())));
}

/// Adds the given rows of one matrix to another.
void append_rows(Eigen::MatrixXd& under, const Eigen::MatrixXd& more,
                 const std::vector<Index>& rows) {
  const Index old = under.rows();
  under.conservativeResize(old + static_cast<Index>(rows.size()), more.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    under.row(old + static_cast<Index>(i)) = more.row(rows[i]);
  }
}

/// Where the recording has a gap, or rows are left out, a new segment begins.
void append_segments(Samples& samples, const Recording& recording, const std::vector<Index>& rows) {
  const Index old = samples.x.rows();
  std::vector<char> starts(static_cast<std::size_t>(recording.samples()), 0);
  for (const Segment& segment : recording.segments) {
    starts[static_cast<std::size_t>(segment.begin)] = 1;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Index row = old + static_cast<Index>(i);
    if (i == 0 || rows[i] != rows[i - 1] + 1 || starts[static_cast<std::size_t>(rows[i])]) {
      samples.segments.push_back({row, row});
    }
    samples.segments.back().end = row + 1;
  }
}

}  // namespace

struct Splitter::Rows {
  Features features;
  Eigen::MatrixXd y;

  std::vector<Index> valid(Index begin, Index end) const {
    std::vector<Index> rows;
    for (Index row = begin; row < end; ++row) {
      if (features.valid[static_cast<std::size_t>(row)]) rows.push_back(row);
    }
    return rows;
  }

  void append_to(Samples& samples, const Recording& recording,
                 const std::vector<Index>& rows) const {
    append_segments(samples, recording, rows);
    append_rows(samples.x, features.x, rows);
    append_rows(samples.y, y, rows);
  }
};

Index training_rows(const Recording& recording, double share) {
  const Index held = validation_rows(recording, share);
  const auto gap = held > 0 && recording.dt > 0.0
                       ? static_cast<Index>(std::lround(kValidationGapSeconds / recording.dt))
                       : 0;
  return std::max<Index>(0, recording.samples() - held - gap);
}

bool wants_pose_noise(const Json& configuration) {
  const auto wants = [](const Json& json) {
    const std::string on = signal_of(json);
    return on == "pose" || on == "both";
  };
  if (wants(configuration)) return true;
  for (const Json& candidate :
       configuration.value("training", Json::object()).value("candidates", Json::array())) {
    if (wants(candidate)) return true;
  }
  return false;
}

Splitter::Splitter(const Identifier& identifier, const TrainingObserver& observer, bool pose_noise)
    : identifier_(identifier), observer_(observer), pose_noise_(pose_noise) {
  require(!pose_noise || identifier.layout.spec.set == FeatureSpec::Set::kPose, Exit::kUsage,
          "noise.on 'pose' or 'both' needs the feature set 'pose', whose features are linear in "
          "the pose; "
          "choose that set or noise.on 'features'");
}

Splitter::Rows Splitter::read(const Recording& recording) const {
  Rows rows{make_features(recording, identifier_.layout),
            measured(recording, identifier_.targets, identifier_.layout.system) -
                identifier_.base_prediction(recording)};
  const Index invalid = rows.features.invalid_count();
  if (invalid > 0 && observer_.note) {
    observer_.note(recording.name + ": " + std::to_string(invalid) + " of " +
                   std::to_string(recording.samples()) +
                   " samples lie near the Euler singularity and are not trained on; the feature "
                   "set 'body' has none");
  }
  return rows;
}

std::vector<Eigen::MatrixXd> Splitter::draws(const Recording& recording, Index before) const {
  std::vector<Eigen::MatrixXd> draws;
  for (std::uint64_t k = 0; pose_noise_ && k < kPoseDraws; ++k) {
    const auto key =
        Rng({identifier_.seed, kPoseStream, static_cast<std::uint64_t>(before), k}).bits();
    draws.push_back(pose_noise(recording, identifier_.layout, key));
  }
  return draws;
}

void Splitter::add(const Recording& recording, double share, Samples& training,
                   Samples& validation) const {
  const Rows all = read(recording);
  const Index total = recording.samples();
  const auto rows = all.valid(0, training_rows(recording, share));
  const auto noise = draws(recording, training.rows());
  training.pose_noise.resize(noise.size());
  for (std::size_t k = 0; k < noise.size(); ++k) {
    append_rows(training.pose_noise[k], noise[k], rows);
  }
  all.append_to(training, recording, rows);
  all.append_to(validation, recording, all.valid(total - validation_rows(recording, share), total));
}

void Splitter::add_whole(const Recording& recording, Samples& samples) const {
  const Rows all = read(recording);
  all.append_to(samples, recording, all.valid(0, recording.samples()));
}

}  // namespace dcnn
