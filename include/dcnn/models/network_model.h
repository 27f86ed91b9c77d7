// SPDX-License-Identifier: Apache-2.0
// A network of layers on some view of the features (network_input.h), trained with Adam.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dcnn/models/model.h"
#include "dcnn/models/network_input.h"
#include "dcnn/nn/batch_plan.h"

namespace dcnn {

/// Targets as the network sees them: (y - mean)/deviation, or raw (0 and 1).
struct TargetScale {
  Eigen::VectorXd mean, deviation;
};

/// How a network is trained (key `training` of a configuration).
struct TrainingSpec {
  Index epochs = 30, batch = 50;
  double l2 = 1e-4;
  bool standardise_targets = true;
  bool shuffle_every_epoch = true;
  bool full_statistics = true;  ///< batch norm: pass over the training set, else running averages
  double ema = 0.0;             ///< decay of the weight average, 0 for none
  double clip = 0.0;      ///< most L2 norm of each parameter tensor's gradient, 0 for no limit
  Index stride = 1;       ///< an epoch sees every stride-th row, each epoch the next ones
  double shrink = 1.0;    ///< of what the trained network says, this share counts
  bool keep_best = true;  ///< the epoch with the least validation RMSE, else the last one
  Json rate;              ///< lr, schedule, drop_factor, drop_period

  static TrainingSpec parse(Options options);
};

class LinearSkip;

class NetworkModel : public Model {
 public:
  /// `layers` as in Network; `input` as in make_input(). With `skip` a ridge regression on the
  /// network's inputs comes first and the network learns what it leaves (linear_skip.h); without
  /// layers it is all there is.
  NetworkModel(std::string kind, const Json& input, const Json& layers, const Problem& problem,
               bool skip = false);
  NetworkModel(const Container& file, const std::string& where);
  ~NetworkModel() override;
  /// What every list of kinds (ModelKind::load) needs for a network.
  static std::unique_ptr<Model> load(const Container& file, const std::string& where);

  bool fit(const Samples& training, const Samples& validation, FitSession& session) override;
  Eigen::MatrixXd predict(const Stream& stream) const override;
  /// With white noise at `snr` dB on every entry of the map of Eq. 7, relative to that entry's
  /// variance over the stream: five copies of a feature whose noise averages out, which no sensor
  /// gives. Empty where the inputs are no such map.
  Eigen::MatrixXd predict_with_noisy_entries(const Stream& stream, double snr,
                                             std::uint64_t key) const;
  std::unique_ptr<Predictor> predictor() const override;
  void set_precision(Precision precision) override;
  bool per_sample() const override;
  Index parameter_count() const override;
  const InputMap& map() const override { return map_; }
  std::optional<Network> network() const override;
  void save(Container& file) const override;

 private:
  friend class Trainer;
  void load_network(const Container& file, const std::string& where);
  /// Fits the skip and makes the scale that of its remainder.
  void fit_skip(const Samples& training);
  /// Of rows whose inputs `write` writes.
  Eigen::MatrixXd predict_rows(Index rows,
                               const std::function<void(Index row, Real* out)>& write) const;
  /// Targets in their units from the network's inputs: the skip and the scaled-back network.
  Eigen::MatrixXd outputs(const Tensor& inputs) const;
  /// Rebuilds the network that predicts, after the weights changed.
  void refold();

  std::string kind_;
  std::vector<std::string> units_;  // of the features
  std::unique_ptr<Network> network_;
  Precision precision_ = Precision::kSingle;
  std::unique_ptr<BatchPlan> batches_;  // of the network as it is now
  InputMap::Spec map_spec_;
  InputMap map_;
  std::unique_ptr<NetworkInput> input_;
  std::unique_ptr<LinearSkip> skip_;  // may be null
  TargetScale scale_;                 // of what the network learns
  Eigen::VectorXd spread_;            // of each training target
  TrainingSpec training_;
  NoiseSpec noise_;
  std::uint64_t seed_ = 0;
};

}  // namespace dcnn
