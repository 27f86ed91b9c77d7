// SPDX-License-Identifier: Apache-2.0
// The shallow networks as identifiers: trained by Levenberg-Marquardt.
#pragma once

#include <string>

#include "dcnn/models/model.h"
#include "dcnn/nn/batch_plan.h"
#include "models/levenberg_marquardt.h"
#include "models/shallow_input.h"
#include "models/shallow_network.h"
#include "models/shallow_residuals.h"

namespace dcnn {

/// Keys of `training`.
struct ShallowTraining {
  LevenbergMarquardt::Settings optimiser;
  Index stride = 1;  ///< every so manyth row is used
  /// random, blocks: 70 % of the rows to train on, 15 % to stop by, 15 % unused, drawn at random
  /// (the toolbox) or contiguous. held-out: all of them to train on, the run's validation rows to
  /// stop by, as the networks trained by Adam.
  std::string division = "random";
  bool standardise = false;  ///< errors in units of each target's spread, else in its own unit

  static ShallowTraining parse(Options options);
};

class ShallowModel : public Model {
 public:
  ShallowModel(std::string kind, bool cascade, const Problem& problem);
  ShallowModel(const Container& file, const std::string& where);

  bool fit(const Samples& training, const Samples& validation, FitSession& session) override;
  Eigen::MatrixXd predict(const Stream& stream) const override;
  std::unique_ptr<Predictor> predictor() const override;
  Index parameter_count() const override { return network_.parameter_count(); }
  const InputMap& map() const override { return map_; }
  std::optional<Network> network() const override;
  void save(Container& file) const override;

 private:
  ShallowModel(std::string kind, bool cascade, const Problem& problem, Options model);

  struct Division {
    std::vector<Index> training, validation;
  };
  void set_weights(Eigen::VectorXd weights);
  void learn_scales(const Samples& training);
  Division divide(const Samples& training) const;
  ShallowResiduals residuals(const Samples& samples, const std::vector<Index>& rows) const;
  bool run(LevenbergMarquardt& optimiser, const Samples& validation, FitSession& session);
  EpochRecord record(const LevenbergMarquardt& optimiser, double mu,
                     const Samples& validation) const;

  std::string kind_;
  std::vector<std::string> units_;  // of the features
  InputMap::Spec map_spec_;
  InputMap map_;
  ShallowInput input_;
  ShallowNetwork network_;
  Eigen::VectorXd weights_;
  std::unique_ptr<BatchPlan> batches_;      // of network(), where there is one
  Eigen::RowVectorXd middle_, half_range_;  // of the targets: unit = middle + half_range·output
  Eigen::VectorXd error_scale_;
  ShallowTraining training_;
  NoiseSpec noise_;
  std::uint64_t seed_ = 0;
};

}  // namespace dcnn
