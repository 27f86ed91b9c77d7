#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/rows.h"

namespace dcnn::check {
namespace {

constexpr double kEdge = 0.15;     // of the range: a register wraps from one end to the other
constexpr double kOrdinary = 0.2;  // of the range: other steps are smaller
constexpr double kTravels = 0.02;  // of the range beyond an end, once unwrapped

struct Wrap {
  double range = 0.0;
  int jumps = 0;
  Eigen::Index first = 0;
};

/// Nothing unless every large step leads from one end of the range to the other, and what follows
/// goes on there.
Wrap wrap_of(const Eigen::VectorXd& x) {
  Wrap wrap;
  const Eigen::VectorXd steps = steps_of(x);
  const double low = x.minCoeff(), high = x.maxCoeff(), range = high - low;
  if (!(range > 0.0)) return wrap;
  double size = 0.0, turns = 0.0, most = 0.0, least = 0.0, unwrapped = 0.0;
  for (Eigen::Index i = 0; i < steps.size(); ++i) {
    const double step = steps[i];
    if (std::abs(step) > kOrdinary * range) {
      const double from = step > 0 ? x[i] - low : high - x[i],
                   to = step > 0 ? high - x[i + 1] : x[i + 1] - low;
      if (from > kEdge * range || to > kEdge * range) return {};
      if (wrap.jumps++ == 0) wrap.first = i;
      turns += step > 0 ? -1.0 : 1.0;
      size = std::max(size, std::abs(step));
    }
    unwrapped = x[i + 1] - low + turns * range;
    most = std::max(most, unwrapped), least = std::min(least, unwrapped);
  }
  if (most < (1.0 + kTravels) * range && least > -kTravels * range) return {};
  wrap.range = std::max(range, size);
  return wrap;
}

/// The power of two (of counts) or the full turn that the range is just below.
bool is_register(double range) {
  for (int bits = 8; bits <= 32; ++bits) {
    const double full = std::ldexp(1.0, bits);
    if (range <= full * 1.0001 && range > 0.97 * full) return true;
  }
  return false;
}

void find_wrap_in(const Log& log, const std::string& name, std::vector<Fault>& out) {
  const Eigen::VectorXd x = log.column(name);
  const Wrap wrap = wrap_of(x);
  if (wrap.jumps == 0) return;
  // Each end is met within kEdge of the range by chance in the square of that; a range that is a
  // power of two by chance in 3 % of a factor of two.
  const double once = kEdge * kEdge * (is_register(wrap.range) ? 0.04 : 1.0);
  double p = 1.0;
  for (int k = 0; k < std::min(wrap.jumps, 20); ++k) p *= once;
  Fault fault = fault_of(wrap_fault, posterior_of_p(p), name,
                         name + " jumps " + std::to_string(wrap.jumps) +
                             " times from one end of its range of " + brief(wrap.range) +
                             " to the other: a register that wraps");
  set_interval(log, wrap.first, wrap.first + 2, fault);
  out.push_back(fault);
}

std::vector<Fault> find_wrap(const Evidence& e) {
  std::vector<Fault> out;
  if (!e.log.smooth) return out;
  std::vector<std::string> names = measured_columns(e.log);
  for (const Joint& joint : e.log.joints) {
    if (!joint.position.empty()) names.push_back(joint.position);
  }
  for (const std::string& name : names) find_wrap_in(e.log, name, out);
  return out;
}

}  // namespace

const FaultKind wrap_fault{"wrap", true,
                           "unwrap the column (add the range after each jump) and write it again",
                           "", find_wrap};

}  // namespace dcnn::check
