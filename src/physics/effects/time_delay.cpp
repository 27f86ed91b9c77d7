#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/effect_law.h"

namespace dcnn::effects::time_delay {
namespace {

constexpr double kLongest = 2.0;  // s

/// The cubic through the four samples about `place` (in samples from `begin`), Lagrange's form;
/// near an end the outermost four. Before the first sample the signal rests at its first value,
/// after the last at that. `x(i)` is sample i of `size`.
template <class Signal>
double interpolate(const Signal& x, Index size, double place) {
  if (place <= 0.0) return x(0);
  if (place >= static_cast<double>(size - 1)) return x(size - 1);
  if (size < 4) return x(std::min<Index>(std::llround(place), size - 1));
  const Index first = std::clamp<Index>(static_cast<Index>(place) - 1, 0, size - 4);
  const double s = place - static_cast<double>(first);
  const auto at = [&](Index i) { return x(first + i); };
  return -(s - 1) * (s - 2) * (s - 3) / 6.0 * at(0) + s * (s - 2) * (s - 3) / 2.0 * at(1) -
         s * (s - 1) * (s - 3) / 2.0 * at(2) + s * (s - 1) * (s - 2) / 6.0 * at(3);
}

/// Lagrange's form through four samples at these instants, which are not even: a row was lost.
double interpolate_uneven(const double* instants, const double* x, double at) {
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    double weight = x[k];
    for (int other = 0; other < 4; ++other) {
      if (other != k) weight *= (at - instants[other]) / (instants[k] - instants[other]);
    }
    sum += weight;
  }
  return sum;
}

/// Rows of a segment in samples since its first. A row that was lost is a step of two or more.
std::vector<double> instants_of(const Motion& motion, const Segment& segment) {
  std::vector<double> instants(static_cast<std::size_t>(segment.size()), 0.0);
  for (std::size_t k = 1; k < instants.size(); ++k) {
    const Index row = segment.begin + static_cast<Index>(k);
    const double step = std::round((motion.t(row) - motion.t(row - 1)) / motion.dt);
    instants[k] = instants[k - 1] + std::max(1.0, step);
  }
  return instants;
}

/// What x was `samples` earlier.
Eigen::VectorXd earlier(const Eigen::VectorXd& x, const std::vector<double>& instants,
                        double samples) {
  const auto size = instants.size();
  Eigen::VectorXd result(x.size());
  std::size_t before = 0;  // the last row at or before the instant that is wanted
  for (std::size_t k = 0; k < size; ++k) {
    const double wanted = instants[k] - samples;
    while (before + 1 < size && instants[before + 1] <= wanted) ++before;
    const std::size_t first = size < 4 ? 0 : std::clamp<std::size_t>(before, 1, size - 3) - 1;
    const bool inside = wanted > 0.0 && wanted < instants.back();
    const bool uneven = size >= 4 && instants[first + 3] - instants[first] > 3.0;
    result(static_cast<Index>(k)) =
        inside && uneven
            ? interpolate_uneven(&instants[first], x.data() + first, wanted)
            : interpolate(x, x.size(),
                          inside ? static_cast<double>(first) + wanted - instants[first]
                                 : (wanted > 0.0 ? static_cast<double>(size) : 0.0));
  }
  return result;
}

void delay(Eigen::MatrixXd& signals, const Motion& motion, double seconds) {
  if (signals.rows() == 0) return;
  for (const Segment& segment : motion.segments) {
    const std::vector<double> instants = instants_of(motion, segment);
    for (Index i = 0; i < signals.cols(); ++i) {
      auto column = signals.col(i).segment(segment.begin, segment.size());
      column = earlier(Eigen::VectorXd(column), instants, seconds / motion.dt);
    }
  }
}

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
    .equation = "F(t) -> F(t - d)",
    .example = R"({"delay_s": 0.013})",
    .needs_time = TimeNeed::kMotion,
    .apply = apply,
    .stream = stream,
    // Seeds reach to half a second, each within a factor of three of the next, for a search ends at
    // the nearest turn of the motion; the one in the middle of the list stands for the least size.
    .fits = {{.shapes = {{"delay", 2e-5, 1.0, {1.5e-4, 0.001, 0.02, 0.004, 0.06, 0.15, 0.4}}},
              .parameters =
                  [](const Eigen::VectorXd&, const Eigen::VectorXd& s) {
                    return Json{{"delay_s", s(0)}};
                  }},
             {.shapes = {{"lead", 2e-5, 0.6, {0.001, 0.02, 0.06, 0.004, 0.15, 0.4}}},
              .parameters =
                  [](const Eigen::VectorXd&, const Eigen::VectorXd& s) {
                    return Json{{"delay_s", -s(0)}};
                  }}},
};

}  // namespace dcnn::effects::time_delay
