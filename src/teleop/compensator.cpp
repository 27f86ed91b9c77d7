// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "dcnn/data/streaming_features.h"
#include "dcnn/physics/streaming_simulator.h"
#include "dcnn/teleop/teleop.h"
#include "runtime/checks.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 0.002;  // s, control

/// A corrected simulator, sample by sample.
class SimulatorCompensator : public Compensator {
 public:
  SimulatorCompensator(const Simulator& simulator, const DerivativeSpec& derivative,
                       const std::string& where, Exit exit)
      : simulator_(simulator, derivative, kTick, where, exit) {}

  Vector3d push(const Vector3d& position, const Vector3d& euler) override {
    return simulator_.push(position, euler).force;
  }

 private:
  StreamingSimulator simulator_;
};

class ModelCompensator : public Compensator {
 public:
  ModelCompensator(const Identifier& identifier, const std::string& where)
      : features_(identifier.layout), predictor_(identifier.model->predictor()), where_(where) {
    constexpr std::array<const char*, 3> kForce{"fx", "fy", "fz"};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& names = identifier.targets.names;
      const auto found = std::find(names.begin(), names.end(), kForce[i]);
      require(found != names.end(), Exit::kModel, where, ": predicts no '", kForce[i],
              "'; give a model of a wrist tool's force");
      columns_[i] = found - names.begin();
    }
    if (!identifier.base) return;
    base_ = std::make_unique<SimulatorCompensator>(
        *identifier.base, identifier.layout.spec.derivative, where, Exit::kModel);
  }

  Vector3d push(const Vector3d& position, const Vector3d& euler) override {
    const Eigen::VectorXd& predicted = predictor_->push(features_.push(position, euler));
    Vector3d force(predicted[columns_[0]], predicted[columns_[1]], predicted[columns_[2]]);
    if (base_) force += base_->push(position, euler);
    require(force.allFinite(), Exit::kModel, where_, ": its prediction is not finite");
    return force;
  }

 private:
  StreamingFeatures features_;
  std::unique_ptr<Predictor> predictor_;
  std::string where_;
  std::array<Index, 3> columns_{};
  std::unique_ptr<SimulatorCompensator> base_;
};

}  // namespace

std::unique_ptr<Compensator> compensate_with(const Identifier& identifier,
                                             const std::string& where) {
  const FeatureLayout& layout = identifier.layout;
  require_online(identifier, where);
  require(std::abs(layout.dt / kTick - 1.0) < 0.01, Exit::kModel, where, ": trained at ",
          1.0 / layout.dt, " Hz, the control runs at 500 Hz; train it on a recording at 500 Hz");
  return std::make_unique<ModelCompensator>(identifier, where);
}

std::unique_ptr<Compensator> compensate_with(const Simulator& simulator, const std::string& where) {
  return std::make_unique<SimulatorCompensator>(
      simulator, simulator.online_derivative.value_or(causal_derivative()), where, Exit::kData);
}

}  // namespace dcnn
