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

namespace dcnn {

/// Rows to learn from or to score on: features in SI, targets in their units.
struct Samples {
  Eigen::MatrixXd x;  ///< (N, F)
  Eigen::MatrixXd y;  ///< (N, targets)
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

class Model {
 public:
  virtual ~Model() = default;

  /// Learns. False when the session wanted to stop: the state is in its last checkpoint.
  virtual bool fit(const Samples& training, const Samples& validation, FitSession& session) = 0;
  /// (N, F) features to (N, targets).
  virtual Eigen::MatrixXd predict(const Eigen::MatrixXd& x) const = 0;
  virtual Index parameter_count() const = 0;
  /// Training statistics of the features: the power that test noise refers to.
  virtual const InputMap& map() const = 0;

  /// Metadata and tensors by which load() of the same kind makes an equal model.
  virtual void save(Container& file) const = 0;
};

/// Size of the problem a model is made for, and everything it may read of the configuration.
struct Problem {
  Index features = 0, targets = 0;
  Json configuration;  ///< resolved: map, model, training, noise
  std::string where;   ///< names the configuration in errors
  std::uint64_t seed = 0;
  std::vector<std::string> units;  ///< of the features; empty where unknown
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
};
std::vector<const ModelKind*> model_kinds();
/// By name; an unknown name is an Error(exit) with a suggestion.
const ModelKind& model_kind(const std::string& name, Exit exit);

}  // namespace dcnn
