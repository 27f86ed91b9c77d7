#include <numbers>

#include "dcnn/data/rotation.h"
#include "physics/effect_law.h"

namespace dcnn::effects::gravity_tilt {
namespace {

void change(ToolModel& model, Options& parameters) {
  const double tx = parameter(parameters, "tilt_x_rad"), ty = parameter(parameters, "tilt_y_rad");
  model.gravity = rotation_from_euler({0.0, ty, tx}) * model.gravity;
}

}  // namespace

const EffectKind effect{
    .name = "gravity_tilt",
    .stage = Stage::kTool,
    .kind = "parameter",
    .meaning = "robot base not level",
    .equation = "g -> Ry(ty) Rx(tx) g",
    .example = R"({"tilt_x_rad": 0.02, "tilt_y_rad": -0.03})",
    .interval = IntervalRule::kNever,
    .change = change,
    .fits = {{.amplitudes = 2,
              .most_strength = std::numbers::pi,  // no turn is longer
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    return Json{{"tilt_x_rad", a(0)}, {"tilt_y_rad", a(1)}};
                  }}},
};

}  // namespace dcnn::effects::gravity_tilt
