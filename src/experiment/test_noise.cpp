// SPDX-License-Identifier: Apache-2.0
#include "experiment/test_noise.h"

#include <bit>
#include <cmath>

#include "dcnn/data/pose_noise.h"
#include "dcnn/models/network_model.h"

namespace dcnn {
namespace {

std::uint64_t noise_key(std::uint64_t seed, double level, int run) {
  return Rng({seed, std::bit_cast<std::uint64_t>(level), static_cast<std::uint64_t>(run)}).bits();
}

NoiseSpec test_noise(const EvaluationRequest& request) {
  NoiseSpec spec;
  if (request.matlab_noise) {
    spec.scope = NoiseSpec::Scope::kMatrix;
    spec.power = NoiseSpec::Power::kMeanSquare;
  }
  return spec;
}

/// Noise on the pose of every recording, carried to the features: by the sum of draws that training
/// uses where features are linear in the pose, else by making them anew.
Eigen::MatrixXd with_noisy_pose(const TestSet& set, const Identifier& identifier,
                                const std::vector<Recording>& recordings, double snr,
                                std::uint64_t key) {
  const double scale = std::pow(10.0, -snr / 20.0);
  const bool linear = identifier.layout.spec.set == FeatureSpec::Set::kPose;
  Eigen::MatrixXd noise;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const auto own = Rng({key, k}).bits();
    stack(noise, linear
                     ? (scale * pose_noise(recordings[k], identifier.layout, own)).eval()
                     : make_features(with_pose_noise(recordings[k], identifier.layout, scale, own),
                                     identifier.layout)
                           .x);
  }
  return linear ? (set.stream.x + noise).eval() : noise;
}

}  // namespace

void stack(Eigen::MatrixXd& under, const Eigen::MatrixXd& more) {
  const auto old = under.rows();
  under.conservativeResize(old + more.rows(), more.cols());
  under.bottomRows(more.rows()) = more;
}

Eigen::MatrixXd every_kth(const Eigen::MatrixXd& rows, Index k) {
  return rows(Eigen::seqN(0, (rows.rows() + k - 1) / k, k), Eigen::all);
}

std::string describe(const EvaluationRequest& request) {
  if (request.noise_on == NoiseSpec::Signal::kPose) {
    return "pose before differentiation, variance of each coordinate over the training rows";
  }
  if (request.noisy_entries) {
    return "entries of X* where a model has them, each by itself (a leak), else features";
  }
  return request.matlab_noise ? "features, mean square over the whole matrix (awgn 'measured')"
                              : "features, variance of each over the training rows";
}

Eigen::MatrixXd noisy_features(const EvaluationRequest& request, const TestSet& set,
                               const Identifier& identifier,
                               const std::vector<Recording>& recordings, const SnrLevel& level,
                               int run) {
  if (!level) return set.stream.x;
  const auto key = noise_key(request.seed, *level, run);
  if (request.noise_on == NoiseSpec::Signal::kPose) {
    return with_noisy_pose(set, identifier, recordings, *level, key);
  }
  const auto deviation =
      noise_deviation(test_noise(request), identifier.model->map(), set.stream.x, level);
  return with_noise(set.stream.x, deviation, key);
}

Eigen::MatrixXd noisy_base(const EvaluationRequest& request, const TestSet& set,
                           const Identifier& identifier, const std::vector<Recording>& recordings,
                           const SnrLevel& level, int run) {
  if (!level || !identifier.base || request.noise_on != NoiseSpec::Signal::kPose) return set.base;
  const auto key = noise_key(request.seed, *level, run);
  Eigen::MatrixXd base;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    stack(base, identifier.base_prediction(with_pose_noise(recordings[k], identifier.layout,
                                                           std::pow(10.0, -*level / 20.0),
                                                           Rng({key, k}).bits())));
  }
  return every_kth(base, request.every);
}

Eigen::MatrixXd predict_noisy_entries(const EvaluationRequest& request, const Model& model,
                                      const Stream& stream, const SnrLevel& level, int run) {
  const auto* network = dynamic_cast<const NetworkModel*>(&model);
  if (!request.noisy_entries || !level || network == nullptr) return {};
  return network->predict_with_noisy_entries({every_kth(stream.x, request.every), {}}, *level,
                                             noise_key(request.seed, *level, run));
}

}  // namespace dcnn
