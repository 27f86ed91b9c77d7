// SPDX-License-Identifier: Apache-2.0
// A model without motion, a standing robot: what the compensator itself does with them can be
// computed by hand.
#pragma once

#include <memory>
#include <utility>

#include "runtime/support.h"

namespace dcnn::test {

/// A model that predicts the same for every sample.
class SteadyModel : public Model {
 public:
  SteadyModel(const InputMap& map, Eigen::VectorXd y) : map_(map), y_(std::move(y)) {}
  bool fit(const Samples&, const Samples&, FitSession&) override { return false; }
  Eigen::MatrixXd predict(const Stream& stream) const override {
    return y_.transpose().replicate(stream.x.rows(), 1);
  }
  std::unique_ptr<Predictor> predictor() const override { return std::make_unique<Steady>(y_); }
  Index parameter_count() const override { return 0; }
  const InputMap& map() const override { return map_; }
  void save(Container&) const override {}

 private:
  struct Steady : Predictor {
    explicit Steady(Eigen::VectorXd value) : y(std::move(value)) {}
    void reset() noexcept override {}
    const Eigen::VectorXd& push(const Eigen::VectorXd&) noexcept override { return y; }
    Eigen::VectorXd y;
  };
  InputMap map_;
  Eigen::VectorXd y_;
};

inline const Recording& slow_motion() {
  static const Recording shared = free_motion(600);
  return shared;
}

/// A model of a wrench, which says `y`, on features of a set.
inline Identifier steady_identifier(const Eigen::VectorXd& y,
                                    FeatureSpec::Set set = FeatureSpec::Set::kBody) {
  static const Identifier body = trained();
  Identifier identifier;
  FeatureSpec spec = body.layout.spec;
  spec.set = set;
  identifier.layout = make_layout({slow_motion()}, spec, {});
  identifier.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
  if (y.size() == 6) {
    identifier.targets = {{"fx", "fy", "fz", "tx", "ty", "tz"}, {"N", "N", "N", "Nm", "Nm", "Nm"}};
  }
  identifier.model = std::make_unique<SteadyModel>(body.model->map(), y);
  return identifier;
}

/// At rest, its force on the sensor is its weight.
inline Simulator tool_with_inertia(bool has_inertia, double rate_hz = 500.0) {
  Json tool = {{"mass_kg", 0.75}, {"com_m", {0.0, 0.0, 0.1}}};
  if (has_inertia) tool["inertia_kgm2"] = {0.006, 0.006, 0.001, 0.0, 0.0, 0.0};
  return parse_simulator({{"tool", tool}, {"sample_rate_hz", rate_hz}}, "test", Exit::kUsage);
}

inline OnlineSample standing_sample(Index k, double dt = 0.002) {
  OnlineSample sample;
  sample.t = static_cast<double>(k) * dt;
  return sample;
}

/// What the sensor reads of a tool at rest, N.
inline Eigen::Vector3d weight_of(const Simulator& simulator) {
  OnlineCompensator compensator(nullptr, &simulator, {}, "test");
  for (Index k = 0; k < 100; ++k) compensator.step(standing_sample(k));
  return compensator.step(standing_sample(100)).tool.head<3>();
}

}  // namespace dcnn::test
