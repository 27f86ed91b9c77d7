// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/delay.h"
#include "physics/effect_law.h"

namespace dcnn::effects::time_delay {
namespace {

constexpr double kLongest = 2.0;  // s

void apply(Wrench& wrench, const Motion& motion, const EffectSpec&, const ToolModel&,
           Options& parameters) {
  const double seconds = parameter(parameters, "delay_s", -kLongest);
  delay(wrench.force, motion, seconds);
  delay(wrench.torque, motion, seconds);
}

/// The newest samples of six signals; older than any that is asked for are written over.
struct Past {
  Eigen::Matrix<double, 6, Eigen::Dynamic> ring;
  Index count = 0;
  double at(Index signal, Index sample) const { return ring(signal, sample % ring.cols()); }
};

EffectStream stream(const EffectSpec&, Options& parameters) {
  constexpr double kFastest = 1e-4;  // s, sample time
  const double seconds = parameter(parameters, "delay_s", -kLongest);
  if (seconds < 0.0) {
    parameters.reject("delay_s",
                      "is negative: a force that leads the pose needs samples that are "
                      "not there yet; delay the force, or predict whole recordings");
  }
  Past past;
  past.ring.setZero(6, 8 + static_cast<Index>(std::min(seconds, kLongest) / kFastest));
  return [seconds, past](InstantWrench& wrench, const Instant& now) mutable {
    if (now.first) past.count = 0;
    past.ring.col(past.count % past.ring.cols()) << wrench.force, wrench.torque;
    ++past.count;
    const Index newest = past.count - 1;
    const double behind =
        now.first ? 0.0 : std::min(seconds / now.dt, double(past.ring.cols() - 4));
    const double place = std::max(0.0, static_cast<double>(newest) - behind);
    // Old samples are gone: count from the oldest that the cubic may need.
    const Index begin = std::max<Index>(0, past.count - past.ring.cols());
    for (Index i = 0; i < 6; ++i) {
      const auto x = [&](Index n) { return past.at(i, begin + n); };
      const double value = interpolate(x, past.count - begin, place - static_cast<double>(begin));
      (i < 3 ? wrench.force[i] : wrench.torque[i - 3]) = value;
    }
  };
}

}  // namespace

const EffectKind effect{
    .name = "time_delay",
    .stage = Stage::kDynamics,
    .kind = "sensor",
    .meaning = "force lags the pose by a pure delay; negative: it leads",
    .on_machine = "delay behind the position (negative: lead)",
    .equation = "F(t) -> F(t - d)",
    .example = R"({"delay_s": 0.013})",
    .needs_time = TimeNeed::kMotion,
    .lateness = "delay_s",
    .apply = apply,
    .stream = stream,
    // Seeds reach to half a second, each within a factor of three of the next, for a search ends at
    // the nearest turn of the motion; the one in the middle of the list stands for the least size.
    .fits = {{.shapes = {{.name = "delay",
                          .low = 2e-5,
                          .high = 1.0,
                          .seeds = {1.5e-4, 0.001, 0.02, 0.004, 0.06, 0.15, 0.4},
                          .peak = ShapeParameter::Peak::kComb}},
              .parameters =
                  [](const Eigen::VectorXd&, const Eigen::VectorXd& s) {
                    return Json{{"delay_s", s(0)}};
                  }},
             {.shapes = {{.name = "lead",
                          .low = 2e-5,
                          .high = 0.6,
                          .seeds = {0.001, 0.02, 0.06, 0.004, 0.15, 0.4},
                          .peak = ShapeParameter::Peak::kComb}},
              .parameters =
                  [](const Eigen::VectorXd&, const Eigen::VectorXd& s) {
                    return Json{{"delay_s", -s(0)}};
                  }}},
    .hidden_by =
        [](const Showing& of) {
          return of.on_machine && of.several_axes
                     ? "the axes share one clock: none of them alone is late"
                     : nullptr;
        },
    .words =
        [](const FoundNumbers& n) {
          const double delay = n.value("delay");
          const std::string size = in_thousandths(std::abs(delay), "ms");
          if (!n.on_machine()) {
            return std::string("the force ") + (delay < 0.0 ? "leads" : "lags") + " the pose by " +
                   size;
          }
          return delay < 0.0 ? "a lead of " + size + " before the position"
                             : "a delay of " + size + " after the position";
        },
};

}  // namespace dcnn::effects::time_delay
