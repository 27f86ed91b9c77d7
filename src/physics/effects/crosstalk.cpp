// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/number.h"
#include "physics/effect_law.h"

namespace dcnn::effects::crosstalk {
namespace {

Eigen::Matrix3d leak(Options& parameters) {
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i != j) C(i, j) = parameter(parameters, std::string("c_") + "xyz"[i] + "xyz"[j]);
    }
  }
  return C;
}

void apply(Wrench& wrench, const Motion&, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  wrench.force *= leak(parameters).transpose();
}

EffectStream stream(const EffectSpec&, Options& parameters) {
  return [C = leak(parameters)](InstantWrench& wrench, const Instant&) {
    wrench.force = (C * wrench.force).eval();
  };
}

}  // namespace

const EffectKind effect{
    .name = "crosstalk",
    .stage = Stage::kSensor,
    .kind = "sensor",
    .meaning = "one axis leaks into another",
    .equation = "F_i += c_ij F_j",
    .example =
        R"({"c_xy": 0.01, "c_xz": -0.005, "c_yx": -0.012, "c_yz": 0.007, "c_zx": 0.014, "c_zy": -0.009})",
    .subject = EffectKind::Subject::kTools,
    .apply = apply,
    .stream = stream,
    .fits = {{.amplitudes = 6,
              .most_strength = 1.0,  // of another axis: a sensor reads its own the most
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"c_xy", a(0)}, {"c_xz", a(1)}, {"c_yx", a(2)},
                                {"c_yz", a(3)}, {"c_zx", a(4)}, {"c_zy", a(5)}};
                  }}},
    .words =
        [](const FoundNumbers& n) {
          return "the sensor's axes leak into each other, by " + brief(100.0 * n.length("c_", "")) +
                 " % in all";
        },
};

}  // namespace dcnn::effects::crosstalk
