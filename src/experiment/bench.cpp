// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/bench.h"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dcnn/data/rotation.h"
#include "dcnn/data/streaming_features.h"

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Clock = std::chrono::steady_clock;

void pin_thread() {
  set_threads(1);
  cpu_set_t processors;
  CPU_ZERO(&processors);
  CPU_SET(static_cast<std::size_t>(std::max(0, ::sched_getcpu())), &processors);
  ::sched_setaffinity(0, sizeof processors, &processors);  // where refused, the numbers spread more
}

/// What is predicted: features, and the poses where the model has one.
struct Input {
  MatrixXd x;     // (N, F)
  MatrixXd pose;  // (N, 6) position and Euler angles, empty without
};

Input drawn_input(const Identifier& identifier, const BenchRequest& request) {
  const InputMap& map = identifier.model->map();
  Input input{with_noise(map.mean().transpose().replicate(request.samples, 1), map.deviation(),
                         request.seed),
              {}};
  if (identifier.layout.spec.set == FeatureSpec::Set::kAxes) return input;
  const double dt = identifier.layout.dt;
  input.pose.resize(request.samples, 6);  // any smooth motion: its values do not change the time
  for (Index k = 0; k < 6; ++k) {
    const double w = 1.0 + 0.3 * static_cast<double>(k);
    for (Index i = 0; i < request.samples; ++i) {
      input.pose(i, k) = 0.1 * std::sin(w * dt * static_cast<double>(i));
    }
  }
  input.pose.rightCols<3>().rowwise() += identifier.layout.circular_mean.transpose();
  return input;
}

Input recorded_input(const Identifier& identifier, const BenchRequest& request) {
  const Recording recording = read_recording(*request.data, request.read, identifier.layout.system);
  Input input{make_features(recording, identifier.layout).x, {}};
  const std::vector<std::string> position{"x", "y", "z"};
  if (identifier.layout.spec.set == FeatureSpec::Set::kAxes || !recording.has_all(position)) {
    return input;
  }
  input.pose.resize(recording.samples(), 6);
  input.pose << recording.block(position), euler_angles(recording);
  return input;
}

/// The model's own layout with the derivatives that can be had while the motion goes on.
FeatureLayout causal(FeatureLayout layout) {
  if (layout.spec.derivative.kind != DerivativeSpec::Kind::kCausalSavitzkyGolay) {
    layout.spec.derivative.kind = DerivativeSpec::Kind::kCausalSavitzkyGolay;
    layout.spec.derivative.order = 2;
  }
  return layout;
}

/// Times one model. A call predicts the samples from `first` on.
class Stopwatch {
 public:
  Stopwatch(const Model& model, const Input& input, const BenchRequest& request)
      : model_(model),
        predictor_(model.predictor()),
        input_(input),
        request_(request),
        row_(input.x.cols()) {}

  void run(BenchRow& row, StreamingFeatures* features) {
    row.features_included = features != nullptr;
    const Index samples = input_.x.rows();
    row.calls = call_count(samples, row.length);
    for (Index k = 0; k < request_.warm_up; ++k) {
      const Index first = k % row.calls * row.length;
      call(first, std::min(row.length, samples - first), features);
    }
    std::vector<double> all, means, totals;
    for (int repetition = 0; repetition < request_.repetitions; ++repetition) {
      if (features) features->reset();
      predictor_->reset();
      double sum = 0.0;
      const auto begin = Clock::now();
      for (Index first = 0; first < samples; first += row.length) {
        all.push_back(call(first, std::min(row.length, samples - first), features));
        sum += all.back();
      }
      totals.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
      means.push_back(sum / static_cast<double>(row.calls));
    }
    row.call = spread(means);
    row.total = spread(totals);
    row.per_sample = row.call.mean * static_cast<double>(row.calls) / static_cast<double>(samples);
    std::sort(all.begin(), all.end());
    row.p50 = quantile(all, 0.5);
    row.p99 = quantile(all, 0.99);
    row.maximum = all.back();
  }

 private:
  static double quantile(const std::vector<double>& sorted, double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }

  double call(Index first, Index count, StreamingFeatures* features) {
    return count == 1 ? call_online(first, features) : call_batch(first, count, features);
  }

  /// One sample, as it comes while the motion goes on.
  double call_online(Index sample, StreamingFeatures* features) {
    row_ = input_.x.row(sample).transpose();
    const auto begin = Clock::now();
    const Eigen::VectorXd& predicted =
        predictor_->push(features ? newest(sample, *features) : row_);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    require(predicted.allFinite(), Exit::kFailure, "a prediction is not finite");
    return seconds;
  }

  double call_batch(Index first, Index count, StreamingFeatures* features) {
    stream_.segments = {{0, count}};
    stream_.x.resize(count, input_.x.cols());
    if (!features) stream_.x = input_.x.middleRows(first, count);
    const auto begin = Clock::now();
    for (Index i = 0; features && i < count; ++i) {
      stream_.x.row(i) = newest(first + i, *features).transpose();
    }
    const MatrixXd predicted = model_.predict(stream_);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    require(predicted.allFinite(), Exit::kFailure, "a prediction is not finite");
    return seconds;
  }

  const Eigen::VectorXd& newest(Index sample, StreamingFeatures& features) const {
    const Eigen::Vector3d position = input_.pose.row(sample).head<3>().transpose();
    const Eigen::Vector3d euler = input_.pose.row(sample).tail<3>().transpose();
    return features.push(position, euler);
  }

  const Model& model_;
  std::unique_ptr<Predictor> predictor_;
  const Input& input_;
  const BenchRequest& request_;
  Stream stream_;
  Eigen::VectorXd row_;
};

}  // namespace

Bench bench(const BenchRequest& request, const std::function<void(int, int)>& progress) {
  pin_thread();
  Bench result;
  result.source = request.data ? request.data->filename().string()
                               : "rows drawn from each model's own input statistics";
  int done = 0;
  const int total = static_cast<int>(2 * request.models.size() * request.lengths.size());
  for (const auto& path : request.models) {
    const Identifier identifier = read_identifier(path, request.precision);
    const std::string file = path.filename().string();
    const Input input =
        request.data ? recorded_input(identifier, request) : drawn_input(identifier, request);
    std::optional<StreamingFeatures> features;
    if (input.pose.rows() > 0 && identifier.layout.dt > 0.0) {
      features.emplace(causal(identifier.layout));
    } else {
      result.notes.push_back(file + ": no rows from the raw pose, since it has none on a clock");
    }
    Stopwatch stopwatch(*identifier.model, input, request);
    for (const Index length : request.lengths) {
      for (const bool from_pose : {false, true}) {
        if (progress) progress(done++, total);
        if (from_pose && !features) continue;
        BenchRow row;
        row.model = identifier.name;
        row.file = file;
        row.length = length;
        stopwatch.run(row, from_pose ? &*features : nullptr);
        result.rows.push_back(row);
      }
    }
  }
  return result;
}

}  // namespace dcnn
