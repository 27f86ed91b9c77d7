#include <cmath>

#include "physics/friction.h"

namespace dcnn {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double fc = parameter(parameters, "fc_n", 0.0);
  const double v0 = parameter(parameters, "v0_mps", kTiny);
  resist(wrench, line_of(spec.axis, motion),
         [=](double v, Index) { return fc * std::tanh(v / v0); });
}

}  // namespace

const EffectKind coulomb_friction_effect{
    .name = "coulomb_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "dry friction",
    .equation = "-fc tanh(v/v0) n",
    .example = R"({"fc_n": 0.4, "v0_mps": 0.01})",
    .axis = AxisRule::kLine,
    .apply = apply,
};

}  // namespace dcnn
