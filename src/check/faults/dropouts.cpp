// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/tails.h"
#include "data/clock.h"

namespace dcnn::check {
namespace {

constexpr double kFarFromZero = 5.0;  // deviations of the channel's noise
constexpr double kMovesAtAll = 1.0;   // of the usual speed: a drive at rest may be off by right

/// Runs of one sentinel value, zero as a rule, that a channel far from it jumps to and back from
/// while the robot moves.
void find_dropouts_in(const Log& log, const std::vector<std::string>& names,
                      std::vector<Fault>& out) {
  const Eigen::MatrixXd values = log.block(names);
  const auto joint = std::find_if(log.joints.begin(), log.joints.end(), [&](const Joint& one) {
    return (one.measured == names[0] && !one.position.empty()) || one.position == names[0];
  });
  const RelativeSpeed speed =
      joint == log.joints.end() ? RelativeSpeed(log) : RelativeSpeed(log, {joint->position});
  const bool positions = !log.positions().empty();
  const auto moves = [&](Eigen::Index begin, Eigen::Index end) {
    return !positions || speed.in(begin, end) >= kMovesAtAll;
  };
  Eigen::Index rows = 0, events = 0, first = 0, ordinary = 0;
  Eigen::VectorXd noise(values.cols());
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    noise[j] = std::max(noise_of(values.col(j)), 0.5 * resolution(values.col(j)));
  }
  const auto zero = [&](Eigen::Index i) { return (values.row(i).array() == 0.0).all(); };
  // Of rows on either side, in one channel on one side of zero: what changes its sign passes there.
  const auto far = [&](Eigen::Index before, Eigen::Index after) {
    const Eigen::ArrayXd a = values.row(before), b = values.row(after);
    const Eigen::ArrayXd least = kFarFromZero * noise.array();
    return ((a > least && b > least) || (a < -least && b < -least)).any();
  };
  const auto beside_gap = [&](Eigen::Index i) {
    return log.t.size() > 0 && is_gap(log.t[i + 1] - log.t[i], log.step);
  };
  Eigen::Index begin = 0;
  for (Eigen::Index i = 0; i < values.rows(); i = begin) {
    begin = i + 1;
    if (!zero(i)) continue;
    Eigen::Index end = i;
    while (end < values.rows() && zero(end)) ++end;
    begin = end;
    if (i == 0 || end == values.rows() || !moves(i - 1, end + 1)) continue;
    if (beside_gap(i - 1) || beside_gap(end - 1)) continue;
    if (!far(i - 1, end)) {
      ordinary += end - i;
      continue;
    }
    if (events++ == 0) first = i;
    rows += end - i;
  }
  if (events == 0) return;
  // A continuous value meets zero exactly in one row of range/resolution, if it passes there at
  // all, and one whose range ends at zero as often as it comes there from nearby; so many times by
  // chance as Poisson has it.
  double chance = 1.0;
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const double range = values.col(j).maxCoeff() - values.col(j).minCoeff();
    if (range > 0.0) chance *= std::min(1.0, resolution(values.col(j)) / range);
  }
  const bool ends_at_zero =
      (values.colwise().minCoeff().array() >= 0.0 || values.colwise().maxCoeff().array() <= 0.0)
          .all();
  const auto n = static_cast<double>(values.rows());
  if (ends_at_zero) chance = std::max(chance, static_cast<double>(ordinary) / n);
  const double p = poisson_tail(static_cast<double>(events), n * chance);
  Fault fault = fault_of(
      dropouts_fault, posterior_of_p(p), names[0],
      std::to_string(rows) + (rows == 1 ? " row of " : " rows of ") + names[0] +
          (names.size() > 1 ? " and its companions" : "") +
          (rows == 1 ? " is exactly zero, though its" : " are exactly zero, though their") +
          " neighbours are not (" + std::to_string(events) +
          (events == 1 ? " dropout)" : " dropouts)"));
  set_interval(log, first, first + 1, fault);
  out.push_back(fault);
}

std::vector<Fault> find_dropouts(const Evidence& e) {
  std::vector<Fault> out;
  if (!e.log.smooth) return out;
  std::vector<std::vector<std::string>> sources = e.log.sensors();
  if (e.log.joints.empty()) sources.push_back(e.log.positions());
  for (const Joint& joint : e.log.joints) {
    if (!joint.position.empty()) sources.push_back({joint.position});
  }
  for (const auto& names : sources) {
    if (names.empty()) continue;
    const std::size_t before = out.size();
    find_dropouts_in(e.log, names, out);
    if (out.size() > before || names.size() == 1) continue;
    for (const std::string& name : names) find_dropouts_in(e.log, {name}, out);
  }
  return out;
}

}  // namespace

const FaultKind dropouts_fault{"dropouts", true, "remove these rows", "", find_dropouts};

}  // namespace dcnn::check
