#include <cmath>

#include "physics/friction.h"

namespace dcnn {
namespace {

void apply(Wrench& wrench, const Motion& motion, const EffectSpec& spec, const ToolModel&,
           Options& parameters) {
  const double fc = parameter(parameters, "fc_n", 0.0), fs = parameter(parameters, "fs_n", 0.0);
  const double vs = parameter(parameters, "vs_mps", kTiny);
  const double v0 = parameter(parameters, "v0_mps", kTiny);
  resist(wrench, line_of(spec.axis, motion), [=](double v, Index) {
    return (fc + (fs - fc) * std::exp(-(v / vs) * (v / vs))) * std::tanh(v / v0);
  });
}

}  // namespace

const EffectKind stribeck_friction_effect{
    .name = "stribeck_friction",
    .stage = Stage::kForce,
    .kind = "structural",
    .meaning = "friction falls with speed",
    .equation = "-(fc + (fs-fc) exp(-(v/vs)^2)) tanh(v/v0) n",
    .example = R"({"fc_n": 0.3, "fs_n": 0.6, "vs_mps": 0.03, "v0_mps": 0.005})",
    .axis = AxisRule::kLine,
    .apply = apply,
};

}  // namespace dcnn
