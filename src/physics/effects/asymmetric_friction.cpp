#include <cmath>

#include "physics/friction.h"

namespace dcnn {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double fc = parameter(parameters, "delta_fc_n"), c = parameter(parameters, "delta_c_nspm");
  const double v0 = parameter(parameters, "v0_mps", kTiny);
  resist(wrench, line_of(spec.axis, motion), [=](double v, Index) {
    return fc * std::abs(std::tanh(v / v0)) + c * std::abs(v);
  });
}

}  // namespace

const EffectKind asymmetric_friction_effect{
    .name = "asymmetric_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "friction that differs between the two directions, by half the difference",
    .equation = "-(delta_fc abs(tanh(v/v0)) + delta_c abs(v)) n",
    .example = R"({"delta_fc_n": 0.1, "delta_c_nspm": 0.5, "v0_mps": 0.01})",
    .axis = AxisRule::kLine,
    .machines_only = true,
    .apply = apply,
    .fits = {{.amplitudes = 2,
              .shapes = {{"v0", 3e-4, 0.3, {0.003, 0.03}}},
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd& s) {
                    return Json{{"delta_fc_n", a(0)}, {"delta_c_nspm", a(1)}, {"v0_mps", s(0)}};
                  }}},
};

}  // namespace dcnn
