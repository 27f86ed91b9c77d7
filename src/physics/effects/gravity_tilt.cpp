// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "dcnn/data/rotation.h"
#include "physics/effect_law.h"

namespace dcnn::effects::gravity_tilt {
namespace {

void change(ToolModel& model, Options& parameters) {
  // Two are given: about x and y, or z in the place of either.
  const bool about_z = parameters.has("tilt_z_rad");
  const auto about = [&](const char* name) {
    return about_z && !parameters.has(name) ? 0.0 : parameter(parameters, name);
  };
  const double tz = about_z ? parameter(parameters, "tilt_z_rad") : 0.0;
  const Eigen::Vector3d turn(tz, about("tilt_y_rad"), about("tilt_x_rad"));
  model.gravity = rotation_from_euler(turn) * model.gravity;
}

constexpr const char* kTurns[] = {"tilt_x_rad", "tilt_y_rad", "tilt_z_rad"};

/// Turns about two base axes, where gravity points mostly along the third: a turn about gravity
/// changes nothing.
template <int first, int second, int along>
EffectFit about() {
  return {.amplitudes = 2,
          .most_strength = std::numbers::pi,  // no turn is longer
          .parameters =
              [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                return Json{{kTurns[first], a(0)}, {kTurns[second], a(1)}};
              },
          .gravity_along = along};
}

}  // namespace

const EffectKind effect{
    .name = "gravity_tilt",
    .stage = Stage::kTool,
    .kind = "parameter",
    .meaning = "robot base not level",
    .equation = "g -> Rz(tz) Ry(ty) Rx(tx) g",
    .example = R"({"tilt_x_rad": 0.02, "tilt_y_rad": -0.03})",
    .interval = IntervalRule::kNever,
    .own = EffectKind::Own::kTools,
    .change = change,
    .fits = {about<1, 2, 0>(), about<0, 2, 1>(), about<0, 1, 2>()},
    .hidden_by = [](const Showing& of) { return of.own_tool ? nullptr : kUnknownTool; },
    .words =
        [](const FoundNumbers& n) {
          return "the robot's base is tilted by " + in_thousandths(n.length("tilt", "rad"), "mrad");
        },
};

}  // namespace dcnn::effects::gravity_tilt
