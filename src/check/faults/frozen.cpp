// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/priors.h"
#include "check/rows.h"
#include "check/stalls.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr double kMoves = 0.3;  // of the usual speed: a sensor at rest may repeat its value

/// p-value of a run of L equal values among n rows whose neighbours are equal with probability q.
double run_p(double n, double length, double q) {
  return std::min(1.0, n * elementary::exp(length * elementary::log(std::max(q, 1.0 / n))));
}

/// Of a value that stands still: that it is a fault's, where a command may be round as well.
double fault_at(const Log& log, double value, double p) {
  const double fault = posterior_of_p(p);
  if (log.joints.empty() || !has_two_digits(value)) return fault;
  const double round = kFaultPrior * kTwoDigits;
  return std::min(fault, round / (round + kCommanded));
}

void find_frozen_column(const Log& log, const std::string& name, std::vector<Fault>& out) {
  const Eigen::VectorXd x = log.column(name);
  const std::vector<Run> runs = runs_of(x);
  const bool whole = runs.size() == 1;
  const double least = x.minCoeff(), most = x.maxCoeff();
  // At zero a channel is off, or was lost; at its ends it may be at a limit.
  std::vector<Run> held;
  for (const Run& run : runs) {
    const bool at_an_end = run.value == least || run.value == most;
    if (whole || (run.value != 0.0 && !at_an_end)) held.push_back(run);
  }
  const auto longest = std::max_element(
      held.begin(), held.end(), [](const Run& a, const Run& b) { return a.length < b.length; });
  if (longest == held.end() || longest->length < 8) return;
  const Eigen::Index end = longest->begin + longest->length;
  if (RelativeSpeed(log).in(longest->begin, end) < kMoves) return;
  // Repeats outside of the run tell how often this channel repeats at all; held samples come in
  // rows.
  double others = 0.0, second = 1.0;
  for (const Run& run : held) {
    if (&run == &*longest) continue;
    others += static_cast<double>(run.length - 1);
    second = std::max(second, static_cast<double>(run.length));
  }
  const double n = static_cast<double>(x.size());
  const double q = whole ? 0.0 : others / std::max(1.0, n - static_cast<double>(longest->length));
  const double p = run_p(n, static_cast<double>(longest->length) / second, q);
  Fault fault = fault_of(frozen_fault, fault_at(log, longest->value, p), name,
                         name + " is exactly " + brief(longest->value) + " for " +
                             std::to_string(longest->length) + " rows while the robot moves");
  set_interval(log, longest->begin, end, fault);
  fault.stops = 2 * longest->length > x.size();  // else the rest of the rows are readings
  out.push_back(fault);
}

void add_stalls(const Log& log, const Stalls& stalls, const std::vector<std::string>& names,
                std::vector<Fault>& out) {
  if (stalls.runs.empty()) return;
  const Run& longest = stalls.runs[0];
  const std::string& name = names[0];
  const bool alone = names.size() == 1;
  const std::size_t times = stalls.runs.size();
  Fault fault = fault_of(frozen_fault, posterior_of_p(stalls.p), name,
                         (alone ? name + " keeps its value for "
                                : name + " and its companions keep their values for ") +
                             std::to_string(longest.length) + " rows" +
                             (times > 1 ? " at most, " + std::to_string(times) + " times," : "") +
                             " while the robot moves");
  set_interval(log, longest.begin, longest.begin + longest.length, fault);
  out.push_back(fault);
}

std::vector<Fault> find_frozen(const Evidence& e) {
  std::vector<Fault> out;
  if (!e.log.smooth) return out;
  for (const std::string& name : measured_columns(e.log)) find_frozen_column(e.log, name, out);
  const bool found = std::any_of(out.begin(), out.end(),
                                 [](const Fault& fault) { return fault.probability >= kLikely; });
  if (found) return out;
  for (const auto& names : e.log.sensors()) {
    if (names.size() > 1) add_stalls(e.log, stalls_of_sensor(e.log, names), names, out);
  }
  const std::vector<std::string> positions = e.log.positions();
  if (!positions.empty()) {
    add_stalls(e.log, stalls_of_positions(e.log, positions, e.log.sensors()), positions, out);
  }
  for (const Joint& joint : e.log.joints) {
    if (joint.position.empty() || joint.measured.empty() || positions.size() == 1) continue;
    add_stalls(e.log, stalls_of_positions(e.log, {joint.position}, {{joint.measured}}),
               {joint.position}, out);
  }
  return out;
}

}  // namespace

const FaultKind frozen_fault{"frozen", true, "cut these rows, or repair the channel", "",
                             find_frozen};

}  // namespace dcnn::check
