// SPDX-License-Identifier: Apache-2.0
// An identifier of tool dynamics: physical units in, physical units out.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/options.h"
#include "dcnn/data/features.h"
#include "dcnn/data/input_map.h"
#include "dcnn/data/noise.h"
#include "dcnn/models/container.h"
#include "dcnn/models/predictor.h"
#include "dcnn/nn/network.h"

namespace dcnn {

/// Feature vectors in the order of time.
struct Stream {
  Eigen::MatrixXd x;  ///< (N, F), SI
  std::vector<Segment>
      segments;  ///< stretches without a gap, in order; no window crosses their ends

  Index rows() const { return x.rows(); }
  /// (N) first row of the segment each row lies in.
  std::vector<Index> segment_begins() const;
};

/// A stream to learn from or to score on, with its targets in their units.
struct Samples : Stream {
  Eigen::MatrixXd y;  ///< (N, targets)
  /// Features of independent draws of unit noise on the pose, (N, F) each: at a level the noisy
  /// features are x + 10^(-snr/20)·draw. Empty where noise is white on the features themselves.
  std::vector<Eigen::MatrixXd> pose_noise;
};

/// What one epoch (or iteration of a fit) came to.
struct EpochRecord {
  Index epoch = 0;                      ///< from 1
  double loss = 0.0;                    ///< mean training loss
  double rate = 0.0;                    ///< learning rate at its first step
  SnrLevel snr_db;                      ///< noise level drawn for it
  std::vector<double> validation_rmse;  ///< per target, in its unit; empty without validation rows
  bool best = false;
};

/// How a fit talks to the world: progress out, a wish to stop in, checkpoints both ways. Every
/// function may be left empty.
struct FitSession {
  std::function<bool()> stop_wanted;
  std::function<void(Index epoch, Index step, Index steps, double loss)> step_done;
  std::function<void(const EpochRecord&)>
      epoch_done;  ///< the model then predicts with that epoch's weights
  std::function<void(const Container&)> save_checkpoint;
  std::optional<Container> checkpoint;  ///< where to go on from
};

/// The training stream with noise of one level: white on the features, or one of the stored draws
/// of noise on the pose. The draw depends on (key, row) alone.
Stream noisy(const Samples& samples, const NoiseSpec& spec, const InputMap& map, SnrLevel snr,
             std::uint64_t key);

/// The same with a level of its own for every NoiseSpec::block_rows rows, drawn by key.
Stream noisy_blocks(const Samples& samples, const NoiseSpec& spec, const InputMap& map,
                    std::uint64_t key);

class Model {
 public:
  virtual ~Model() = default;

  /// Learns. False when the session wanted to stop: the state is in its last checkpoint.
  virtual bool fit(const Samples& training, const Samples& validation, FitSession& session) = 0;
  /// (N, targets), one row per row of the stream; the rows before the first one of a segment are
  /// taken to equal it.
  virtual Eigen::MatrixXd predict(const Stream& stream) const = 0;
  /// The model as it is now for one sample after another; it may outlive the model.
  virtual std::unique_ptr<Predictor> predictor() const = 0;
  /// Every prediction depends on its own row alone, so that rows can be left out.
  virtual bool per_sample() const { return false; }
  /// What predict() and the predictors made from now on multiply in; nothing that is saved. What
  /// the model has no kernel for is Error(kUsage).
  virtual void set_precision(Precision precision) {
    require(precision == Precision::kSingle, Exit::kUsage,
            "this kind of model has no network to multiply in 16-bit integers");
  }
  virtual Index parameter_count() const = 0;
  /// Training statistics of the features: the power that test noise refers to.
  virtual const InputMap& map() const = 0;
  /// The network of layers inside, at inference, on its own inputs and outputs (before targets get
  /// their units); nothing where there is none or something stands beside it.
  virtual std::optional<Network> network() const { return std::nullopt; }
  /// What the user should know of the last fit, one line each.
  virtual std::vector<std::string> notes() const { return {}; }

  /// Metadata and tensors by which load() of the same kind makes an equal model.
  virtual void save(Container& file) const = 0;

  /// (N) How far the motion of each row's last second is from that of the training: above 1 an
  /// error may be of any size. Empty where the kind does not measure it.
  virtual Eigen::VectorXd novelty(const Stream& /*stream*/) const { return {}; }
};

/// Size of the problem a model is made for, and everything it may read of the configuration.
struct Problem {
  FeatureLayout layout;  ///< names, units and set of the features, and their clock
  Targets targets;
  Json configuration;  ///< resolved: map, model, training, noise
  std::string where;   ///< names the configuration in errors
  std::uint64_t seed = 0;
  bool is_remainder = false;  ///< the targets are what a simulator leaves

  Index features() const { return static_cast<Index>(layout.names.size()); }
  Index outputs() const { return static_cast<Index>(targets.names.size()); }
};

/// One row of the list of models (models.def).
struct ModelKind {
  const char* name;
  const char* summary;  ///< one line for --help
  /// Defaults of a preset (quick|standard|fair|paper): sections of the configuration; `axes` for
  /// --system data.
  Json (*preset)(const std::string& preset, bool axes);
  std::unique_ptr<Model> (*make)(const Problem& problem);
  std::unique_ptr<Model> (*load)(const Container& file, const std::string& where);
  bool takes_static_lists = false;  ///< the orientation alone, without time, is enough
};
std::vector<const ModelKind*> model_kinds();
/// By name; an unknown name is an Error(exit) with a suggestion.
const ModelKind& model_kind(const std::string& name, Exit exit);

}  // namespace dcnn
