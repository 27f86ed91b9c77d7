// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/model.h"

#include <cmath>

#include "dcnn/data/rotation.h"
#include "models/frame_tcn/material.h"
#include "models/frame_tcn/pose_noise_moments.h"
#include "models/frame_tcn/recipe.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace frame_tcn {
namespace {

constexpr Index kMostExperts = 64, kMostClouds = 256, kMostLevels = 256, kMostEdge = 1000000;

/// Row-major, as files hold matrices.
StoredTensor stored(const std::string& name, const Eigen::MatrixXd& m) {
  std::vector<double> values(static_cast<std::size_t>(m.size()));
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      values.data(), m.rows(), m.cols()) = m;
  return {name, {m.rows(), m.cols()}, std::move(values)};
}

Eigen::MatrixXd loaded(const Container& file, const std::string& name, const Eigen::MatrixXd& like,
                       const std::string& where) {
  const auto& values = stored_values<double>(file, name, where);
  require(file.find(name)->shape == std::vector<Index>{like.rows(), like.cols()}, Exit::kModel,
          where, ": tensor '", name, "' has another shape than the architecture says");
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      values.data(), like.rows(), like.cols());
}

}  // namespace

FrameTcn::FrameTcn(const Problem& problem)
    : spec_(Spec::parse(problem)), units_(problem.layout.units) {
  require(problem.layout.spec.set == FeatureSpec::Set::kPose && problem.features() == kChannels,
          Exit::kUsage, problem.where,
          ": model 'frame-tcn' needs the feature set 'pose' with all its 15 rows (position and "
          "orientation logged)");
  require(problem.outputs() % 3 == 0, Exit::kUsage, problem.where,
          ": model 'frame-tcn' predicts vectors of three (force, torque), not ", problem.outputs(),
          " targets");
  front_ = Front(spec_.experts());
  Rng rng({spec_.seed, 100});
  net_ = Net({spec_.experts(), problem.outputs() / 3, spec_.saturation, spec_.dense}, rng);
  net_.mounting = spec_.mounting;
  if (!spec_.pose_snr.empty()) net_.edge = edge_rows(spec_.layout);
  spread_ = Eigen::VectorXd::Ones(problem.outputs() / 3);
}

FrameTcn::FrameTcn(const Container& file, const std::string& where) {
  const Json plan = parse_json(stored_text(file, "plan", where), where, Exit::kModel);
  Options options(plan, where, Exit::kModel);
  const auto experts = static_cast<Index>(options.number("experts", 0, 1, kMostExperts));
  const auto triples = static_cast<Index>(options.number("triples", 0, 1, 2));
  const auto clouds = static_cast<Index>(options.number("clouds", 0, 1, kMostClouds));
  const auto levels = static_cast<Index>(options.number("levels", 0, 1, kMostLevels));
  const auto edge = static_cast<Index>(options.number("edge", 0, 0, kMostEdge));
  const bool saturation = options.get<bool>("saturation");
  const bool dense = options.get("dense", false);
  options.finish();
  map_ = InputMap::parse(parse_json(stored_text(file, "map", where), where, Exit::kModel), where,
                         Exit::kModel);
  require(map_.features() == kChannels, Exit::kModel, where, ": its statistics are not of 15 rows");
  require(!dense || experts == kBlocks, Exit::kModel, where, ": its dense layers need ", kBlocks,
          " means a channel");
  front_ = Front(experts);
  Rng rng(0);
  net_ = Net({experts, triples, saturation, dense}, rng);
  net_.edge = edge;
  spread_ = Eigen::VectorXd::Ones(triples);
  novelty_ = Novelty(clouds);
  pace_ = Pace(levels);
  auto all = slots();
  for (Slot& slot : all) slot.value = loaded(file, slot.name, slot.value, where);
  assign(all);
  require((net_.scale.array() > 0.0).all() && (net_.level_scale.array() > 0.0).all() &&
              (net_.unit.array() > 0.0).all() && (spread_.array() > 0.0).all() &&
              (novelty_.limit.array() > 0.0).all(),
          Exit::kModel, where, ": a scale is not positive");
  require(predict({map_.mean().transpose(), {}}).allFinite(), Exit::kModel, where,
          ": its prediction at the mean of the training is not finite");
}

std::vector<FrameTcn::Slot> FrameTcn::slots() const {
  std::vector<Slot> all;
  for (std::size_t g = 0; g < kGroups; ++g) {
    for (std::size_t h = 0; h < kHistories.size(); ++h) {
      all.push_back({"convolution." + std::to_string(g) + "." + std::to_string(kHistories[h]),
                     front_.weights[g][h]});
    }
  }
  Eigen::MatrixXd channels(kChannels, 5);
  channels << net_.mean, net_.scale, net_.level_mean, net_.level_scale, net_.level_noisy;
  all.push_back({"parameters", net_.parameters});
  all.push_back({"channels", channels});
  all.push_back({"unit", net_.unit});
  all.push_back({"mounting", net_.mounting});
  all.push_back({"spread", spread_});
  all.push_back({"novelty.mean", novelty_.mean});
  all.push_back({"novelty.whiten", novelty_.whiten});
  all.push_back({"novelty.limit", novelty_.limit});
  all.push_back({"pace.level", pace_.level});
  all.push_back({"pace.limit", pace_.limit});
  return all;
}

void FrameTcn::assign(const std::vector<Slot>& all) {
  auto next = all.begin();
  for (Bank& bank : front_.weights) {
    for (auto& weights : bank) weights = (next++)->value;
  }
  net_.parameters = (next++)->value;
  const Eigen::MatrixXd& channels = (next++)->value;
  net_.mean = channels.col(0);
  net_.scale = channels.col(1);
  net_.level_mean = channels.col(2);
  net_.level_scale = channels.col(3);
  net_.level_noisy = channels.col(4);
  net_.unit = (next++)->value;
  net_.mounting = (next++)->value;
  spread_ = (next++)->value;
  novelty_.mean = (next++)->value;
  novelty_.whiten = (next++)->value;
  novelty_.limit = (next++)->value;
  pace_.level = (next++)->value;
  pace_.limit = (next++)->value;
}

void FrameTcn::save(Container& file) const {
  file.metadata["model"] = "frame-tcn";
  file.metadata["map"] = map_.to_json().dump();
  Json plan{{"experts", net_.plan().experts},
            {"triples", net_.plan().triples},
            {"clouds", novelty_.clouds()},
            {"levels", pace_.levels()},
            {"edge", net_.edge},
            {"saturation", net_.plan().saturation}};
  if (net_.plan().dense) plan["dense"] = true;
  file.metadata["plan"] = plan.dump();
  for (const Slot& slot : slots()) file.tensors.push_back(stored(slot.name, slot.value));
}

Index FrameTcn::parameter_count() const {
  Index count = net_.parameters.size();
  if (net_.plan().dense) return count;  // its front hands on the block means
  for (const Bank& bank : front_.weights) {
    for (const auto& weights : bank) count += weights.size();
  }
  return count;
}

bool FrameTcn::fit(const Samples& training, const Samples& validation, FitSession& session) {
  map_ = InputMap(training.x, {}, units_);
  Recipe recipe(*this, training, validation, session);
  return recipe.run();
}

Eigen::MatrixXd FrameTcn::predict(const Stream& stream) const {
  constexpr Index kBatch = 256;
  const Eigen::MatrixXd x = normalised(stream.x, net_.mean, net_.scale);
  const BlockMeans blocks(x, stream.segments);
  const Eigen::MatrixXd rough = roughness(x, x, stream.segments, net_.edge);
  Eigen::MatrixXd result(stream.rows(), 3 * net_.plan().triples);
  for_each_piece((stream.rows() + kBatch - 1) / kBatch, [&](Index k) {
    const Index first = k * kBatch, count = std::min(kBatch, stream.rows() - first);
    Pass pass;
    pass.levels = net_.standard_levels(rough.middleCols(first, count));
    pass.experts = front_.apply(blocks, first, count);
    net_.denoise(pass);
    net_.features(pass);
    net_.product(pass);
    for (Index t = 0; t < spread_.size(); ++t) {
      result.block(first, 3 * t, count, 3) = spread_[t] * pass.out.middleRows(3 * t, 3).transpose();
    }
  });
  return result;
}

Eigen::VectorXd FrameTcn::novelty(const Stream& stream) const {
  const Eigen::MatrixXd x = normalised(stream.x, net_.mean, net_.scale);
  return novelty_.score(motion_signs(x, stream.segments)).cwiseMax(pace_score(x, stream.segments));
}

/// Each row has the score of the last one before it that was looked at.
Eigen::VectorXd FrameTcn::pace_score(const Eigen::MatrixXd& x,
                                     const std::vector<Segment>& segments) const {
  Eigen::VectorXd score = Eigen::VectorXd::Zero(x.rows());
  const BlockMeans blocks(x, segments);
  const Eigen::MatrixXd rough = roughness(x, x, segments, net_.edge);
  for (const Segment& s : stretches(x.rows(), segments)) {
    const Index count = s.size() / Pace::kStride, first = s.begin + Pace::kStride - 1;
    if (count == 0) continue;
    Pass pass;
    pass.levels = net_.standard_levels(rough(Eigen::all, Eigen::seqN(first, count, Pace::kStride)));
    pass.experts.resize(kChannels * front_.experts, count);
    for (Index k = 0; k < count; ++k) {
      pass.experts.col(k) = front_.apply(blocks, first + k * Pace::kStride, 1);
    }
    net_.denoise(pass);
    const Eigen::VectorXd own = pace_.score(pass.clean, pass.levels);
    for (Index i = first; i < s.end; ++i) score[i] = own[(i - first) / Pace::kStride];
  }
  return score;
}

}  // namespace frame_tcn
}  // namespace dcnn
