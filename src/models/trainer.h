// SPDX-License-Identifier: Apache-2.0
// One training of a NetworkModel: epochs of Adam that can stop anywhere and go on to the same
// bytes.
#pragma once

#include <memory>
#include <vector>

#include "dcnn/models/network_model.h"
#include "dcnn/nn/optimizer.h"

namespace dcnn {

/// Everything random comes from (seed, epoch, step), so the state is the numbers below and no more:
/// weights, moments, averages, the best weights so far, and the position in the epoch.
class Trainer {
 public:
  Trainer(NetworkModel& model, const Samples& training, const Samples& validation,
          FitSession& session);

  /// False when stopped before the last epoch; the checkpoint has then been saved.
  bool run();

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void begin_epoch();
  bool run_steps();
  void step();
  Tensor gather(const PreparedStream& stream, const std::vector<std::int64_t>& order,
                Index first) const;
  Tensor gather_targets(const Tensor& inputs, Index first) const;
  void weigh_rows(const std::vector<std::size_t>& level_of);
  std::vector<Real> gather_factors(Index first) const;
  void finish_epoch();
  void collect_statistics();
  std::vector<double> validation_rmse() const;
  void keep_if_best(EpochRecord& record);
  void restore_best();
  std::vector<NamedTensor> everything() const;
  void save_checkpoint() const;
  void restore_checkpoint(const Container& file);

  NetworkModel& model_;
  const Samples& validation_;
  FitSession& session_;
  const TrainingSpec& spec_;
  const Samples& training_;
  RowMajor y_;  // targets, scaled
  Index steps_per_epoch_;
  bool has_statistics_;  // of batch norm, to be collected after every epoch
  std::unique_ptr<Adam> adam_;
  std::unique_ptr<WeightAverage> average_;
  std::unique_ptr<LearningRate> rate_;
  std::vector<NamedTensor> best_;  // copies of the network's state
  double best_score_ = std::numeric_limits<double>::infinity();

  Index epoch_ = 0, step_ = 0;  // the next one to do, from 0
  double loss_sum_ = 0.0;
  std::vector<std::int64_t> order_;  // of this epoch
  std::vector<Real> row_factors_;    // root of each row's weight in the loss; empty: all alike
  SnrLevel snr_;
  PreparedStream noisy_;
};

}  // namespace dcnn
