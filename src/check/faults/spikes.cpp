// SPDX-License-Identifier: Apache-2.0
#include "data/spikes.h"

#include <algorithm>
#include <cmath>

#include "check/excursions.h"
#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr double kTurnsAsFar = 0.5;  // of an angle's excursion: a turn of the pose by rounding

void find_spikes_in(const Log& log, const std::string& name, const Excursions& found,
                    std::vector<Fault>& out) {
  if (found.rows.empty()) return;
  const std::string words =
      found.width == 1 ? Spikes{found.rows, found.height, found.p}.words(name) : found.words(name);
  Fault fault = fault_of(spikes_fault, posterior_of_p(found.p), name, words);
  set_interval(log, found.rows.front(), found.rows.front() + found.width, fault);
  out.push_back(fault);
}

/// Near the singularity of Euler angles two of them jump where the pose does not turn: whether it
/// turns in each of these rows as the angle does.
bool turns(const Evidence& e, const Eigen::VectorXd& angle, const Excursions& found) {
  const auto R = orientations(e.log, e.adopted.reading);
  return std::all_of(found.rows.begin(), found.rows.end(), [&](Index row) {
    const auto& before = R[static_cast<std::size_t>(row - 1)];
    const auto& here = R[static_cast<std::size_t>(row)];
    const double chord = (here - before).norm() / std::sqrt(2.0);  // 2 sin(turn/2)
    const double step = e.adopted.reading.angle * std::abs(angle[row] - angle[row - 1]);
    return chord > kTurnsAsFar * 2.0 * std::abs(elementary::sin(0.5 * step));
  });
}

std::vector<Fault> find_spikes(const Evidence& e) {
  std::vector<Fault> out;
  if (!e.log.smooth) return out;
  for (const std::string& name : measured_columns(e.log)) {
    find_spikes_in(e.log, name, excursions_of(e.log.column(name)), out);
  }
  const std::vector<std::string> names = e.log.positions();
  const Eigen::MatrixXd positions = continuous_positions(e.log, e.adopted.reading.angle);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Eigen::VectorXd x = positions.col(static_cast<Index>(k));
    const Excursions found = excursions_of(x);
    const bool euler = std::find(kEuler.begin(), kEuler.end(), names[k]) != kEuler.end();
    if (euler && e.log.has_pose() && !turns(e, x, found)) continue;
    find_spikes_in(e.log, names[k], found, out);
  }
  return out;
}

}  // namespace

const FaultKind spikes_fault{"spikes", false, "remove these rows", "", find_spikes};

}  // namespace dcnn::check
