// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/excursions.h"
#include "check/rows.h"
#include "data/spikes.h"

namespace dcnn::check {
namespace {

constexpr double kEdge = 0.15;       // of the range: a register wraps from one end to the other
constexpr double kOrdinary = 0.2;    // of the range: other steps are smaller
constexpr double kTravels = 0.02;    // of the range beyond an end, once unwrapped
constexpr double kTurnError = 1e-3;  // of a full turn: what a row's motion changes by

struct Wrap {
  double range = 0.0;
  int jumps = 0;
  Eigen::Index first = 0;
  bool turns = true;  ///< each jump is a full turn beside the steps before and after it
};

/// Whether step `i` is a full turn, in rad or degrees, but for what the angle moves in that row.
bool is_full_turn(const Eigen::VectorXd& steps, Eigen::Index i) {
  if (i == 0 || i + 1 == steps.size()) return false;
  const double own = std::abs(steps[i] - 0.5 * (steps[i - 1] + steps[i + 1]));
  const auto is = [&](double turn) { return std::abs(own - turn) < kTurnError * turn; };
  return is(2.0 * std::numbers::pi) || is(360.0);
}

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
      wrap.turns = wrap.turns && is_full_turn(steps, i);
      size = std::max(size, std::abs(step));
    }
    unwrapped = x[i + 1] - low + turns * range;
    most = std::max(most, unwrapped), least = std::min(least, unwrapped);
  }
  if (most < (1.0 + kTravels) * range && least > -kTravels * range) return {};
  wrap.range = std::max(range, size);
  return wrap;
}

/// Steps of a full turn that their neighbours do not share: no joint moves so in a row. The tail is
/// Student's with five degrees of freedom.
void find_turns_in(const Log& log, const std::string& name, std::vector<Fault>& out) {
  const Eigen::VectorXd x = log.column(name), steps = steps_of(x);
  const double usual = robust_deviation(steps_of(steps));
  int jumps = 0;
  Eigen::Index first = 0;
  double least = 0.0;
  for (Eigen::Index i = 0; i < steps.size(); ++i) {
    if (!is_full_turn(steps, i)) continue;
    if (jumps++ == 0) first = i;
    least = least == 0.0 ? std::abs(steps[i]) : std::min(least, std::abs(steps[i]));
  }
  if (jumps == 0) return;
  const double z = least / std::max(usual, 1e-12 * least);
  const double p = std::min(1.0, static_cast<double>(steps.size()) * heavy_tail(z));
  Fault fault = fault_of(wrap_fault, posterior_of_p(p), name,
                         name + " jumps by a full turn " + std::to_string(jumps) +
                             (jumps == 1 ? " time" : " times") +
                             ": an angle that begins anew after each turn");
  set_interval(log, first, first + 2, fault);
  out.push_back(fault);
}

/// The power of two (of counts) that the range is just below.
bool is_register(double range) {
  for (int bits = 8; bits <= 32; ++bits) {
    const double full = std::ldexp(1.0, bits);
    if (range <= full * 1.0001 && range > 0.97 * full) return true;
  }
  return false;
}

void find_wrap_in(const Log& log, const std::string& name, std::vector<Fault>& out) {
  const Eigen::VectorXd logged = log.column(name);
  // A few rows that were misread jump there and back; what wraps goes on at the other end.
  const Excursions few = excursions_of(logged);
  const Wrap wrap = wrap_of(posterior_of_p(few.p) < kLikely ? logged : without(few, logged));
  if (wrap.jumps == 0) return;
  // Each end is met within kEdge of the range by chance in the square of that; a range that is a
  // power of two by chance in 3 % of a factor of two, a jump a full turn in kTurnError on either
  // side of it.
  const double size = wrap.turns ? 2.0 * kTurnError : is_register(wrap.range) ? 0.04 : 1.0;
  const double once = kEdge * kEdge * size;
  double p = 1.0;
  for (int k = 0; k < std::min(wrap.jumps, 20); ++k) p *= once;
  Fault fault = fault_of(
      wrap_fault, posterior_of_p(p), name,
      name + " jumps " + std::to_string(wrap.jumps) + " times from one end of its range of " +
          brief(wrap.range) + " to the other: " +
          (wrap.turns ? "an angle that begins anew after each turn" : "a register that wraps"));
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
  for (const Joint& joint : e.log.joints) {
    const bool told = std::any_of(out.begin(), out.end(), [&](const Fault& fault) {
      return fault.channel == joint.position && fault.probability >= kLikely;
    });
    if (joint.turns && !joint.position.empty() && !told) find_turns_in(e.log, joint.position, out);
  }
  return out;
}

}  // namespace

const FaultKind wrap_fault{
    "wrap", true,
    "unwrap the column: dcnn-import LOG --wrap COLUMN=RANGE, or add the range after each jump", "",
    find_wrap};

}  // namespace dcnn::check
