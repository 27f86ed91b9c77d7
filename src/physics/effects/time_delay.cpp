#include <algorithm>
#include <cmath>

#include "physics/effect_law.h"

namespace dcnn {
namespace {

/// The cubic through the four samples about `place` (in samples from `begin`), Lagrange's form;
/// near an end the outermost four. Before the first sample the signal rests at its first value.
double interpolate(const Eigen::VectorXd& x, const Segment& segment, double place) {
  if (place <= 0.0) return x(segment.begin);
  if (segment.size() < 4) {
    return x(segment.begin + std::min<Index>(std::llround(place), segment.size() - 1));
  }
  const Index first = std::clamp<Index>(static_cast<Index>(place) - 1, 0, segment.size() - 4);
  const double s = place - static_cast<double>(first);
  const auto at = [&](Index i) { return x(segment.begin + first + i); };
  return -(s - 1) * (s - 2) * (s - 3) / 6.0 * at(0) + s * (s - 2) * (s - 3) / 2.0 * at(1) -
         s * (s - 1) * (s - 3) / 2.0 * at(2) + s * (s - 1) * (s - 2) / 6.0 * at(3);
}

void delay(Eigen::MatrixXd& signals, const Motion& motion, double seconds) {
  for (Index i = 0; i < signals.cols() && signals.rows() > 0; ++i) {
    const Eigen::VectorXd x = signals.col(i);
    for (const Segment& segment : motion.segments) {
      for (Index k = segment.begin; k < segment.end; ++k) {
        const double place = static_cast<double>(k - segment.begin) - seconds / motion.dt;
        signals(k, i) = interpolate(x, segment, place);
      }
    }
  }
}

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const double seconds = parameter(parameters, "delay_s", 0.0);
  delay(wrench.force, motion, seconds);
  delay(wrench.torque, motion, seconds);
}

}  // namespace

const EffectKind time_delay_effect{
    .name = "time_delay",
    .stage = Stage::kDynamics,
    .kind = "sensor",
    .meaning = "force lags the pose by a pure delay",
    .equation = "F(t) -> F(t - d)",
    .example = R"({"delay_s": 0.013})",
    .needs_time = true,
    .apply = apply,
    .fits = {{.shapes = {{"delay", 2e-5, 1.0, {0.003, 0.02}}},
              .parameters =
                  [](const Eigen::VectorXd&, const Eigen::VectorXd& s) {
                    return Json{{"delay_s", s(0)}};
                  }}},
};

}  // namespace dcnn
