// SPDX-License-Identifier: Apache-2.0
#include "check/excursions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/statistics.h"
#include "data/resolution.h"
#include "data/spikes.h"
#include "dcnn/core/number.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr Index kWidest = 3;            // rows
constexpr double kLeastHeight = 8.0;    // deviations, as of single rows (data/spikes.cpp)
constexpr double kAlike = 0.3;          // of a height: neighbours, and the rows moved, as there
constexpr double kTurnTolerance = 0.1;  // of a turn: steps of an angle that begins anew

/// Least distance of rows [i, i + width) from the middle of the two rows on either side, with its
/// sign; 0 where the rows lie on both sides of it.
Eigen::VectorXd distances(const Eigen::VectorXd& x, Index width) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(x.size());
  for (Index i = 2; i + width + 1 < x.size(); ++i) {
    double near[4] = {x[i - 2], x[i - 1], x[i + width], x[i + width + 1]};
    std::sort(near, near + 4);
    const auto off = x.segment(i, width).array() - 0.5 * (near[1] + near[2]);
    if (off.minCoeff() > 0.0) out[i] = off.minCoeff();
    if (off.maxCoeff() < 0.0) out[i] = off.maxCoeff();
  }
  return out;
}

bool stands_out(const Eigen::VectorXd& x, Index i, Index width, double height) {
  const Eigen::Vector4d near(x[i - 2], x[i - 1], x[i + width], x[i + width + 1]);
  const auto rows = x.segment(i, width).array();
  return near.maxCoeff() - near.minCoeff() <= kAlike * height &&
         rows.maxCoeff() - rows.minCoeff() <= kAlike * height && (rows != 0.0).all();
}

Excursions of_width(const Eigen::VectorXd& x, Index width) {
  Excursions out;
  out.width = width;
  const Eigen::VectorXd distance = distances(x, width);
  const double scale = std::max(deviation_of_moving(distance), 0.5 * resolution(x));
  if (scale <= 0.0) return out;
  std::vector<std::pair<double, Index>> found;  // height, row
  for (Index i = 2; i + width + 1 < x.size(); ++i) {
    const double height = std::abs(distance[i]);
    if (height >= kLeastHeight * scale && stands_out(x, i, width, height)) {
      found.emplace_back(height / scale, i);
    }
  }
  std::sort(found.rbegin(), found.rend());
  std::vector<double> heights;
  for (const auto& [height, row] : found) heights.push_back(height);
  const Outliers far = least_likely_outliers(heights, x.size());
  if (far.count == 0) return out;
  for (std::size_t k = 0; k < far.count; ++k) out.rows.push_back(found[k].second);
  std::sort(out.rows.begin(), out.rows.end());
  out.height = found[0].first;
  out.p = far.p;
  return out;
}

/// Whether a column of the pose or of a joint's position is an angle; lengths are none.
bool is_angle(const Log& log, const std::string& name) {
  if (std::find(kEuler.begin(), kEuler.end(), name) != kEuler.end()) return true;
  return std::any_of(log.joints.begin(), log.joints.end(),
                     [&](const Joint& joint) { return joint.position == name && joint.turns; });
}

/// Takes out the steps of one turn, in the angles' unit.
void remove_turns(double turn, Eigen::Ref<Eigen::VectorXd> angles) {
  double turns = 0.0;
  for (Index i = 1; i < angles.size(); ++i) {
    const double step = angles[i] + turns - angles[i - 1];
    if (std::abs(std::abs(step) - turn) < kTurnTolerance * turn) turns -= std::copysign(turn, step);
    angles[i] += turns;
  }
}

void align_signs(Eigen::Ref<Eigen::MatrixXd> quaternions) {
  for (Index i = 1; i < quaternions.rows(); ++i) {
    if (quaternions.row(i).dot(quaternions.row(i - 1)) < 0.0) quaternions.row(i) *= -1.0;
  }
}

}  // namespace

std::string Excursions::words(const std::string& column) const {
  const bool one = rows.size() == 1;
  return std::to_string(rows.size()) + (one ? " stretch of " : " stretches of ") +
         std::to_string(width) + " rows of " + column + (one ? " is " : " are up to ") +
         brief(height) + " deviations off " + (one ? "its" : "their") + " neighbours";
}

Excursions excursions_of(const Eigen::VectorXd& values) {
  const Spikes single = spikes_of(values);
  Excursions best{1, single.rows, single.height, single.p};
  for (Index width = 2; width <= kWidest; ++width) {
    Excursions wider = of_width(values, width);
    wider.p = std::min(1.0, kWiderRarer * wider.p);
    if (wider.p < best.p) best = std::move(wider);
  }
  return best;
}

Eigen::VectorXd without(const Excursions& excursions, Eigen::VectorXd values) {
  for (const Index row : excursions.rows) {
    const double before = values[row - 1], after = values[row + excursions.width];
    values.segment(row, excursions.width).setConstant(0.5 * (before + after));
  }
  return values;
}

Eigen::MatrixXd continuous_positions(const Log& log, double angle_unit) {
  const std::vector<std::string> names = log.positions();
  Eigen::MatrixXd columns = log.block(names);
  if (log.has_quaternion()) {
    const auto at = std::find(names.begin(), names.end(), kQuaternion[0]);
    if (at != names.end()) align_signs(columns.middleCols(at - names.begin(), 4));
  }
  const double turn = 2.0 * std::numbers::pi / angle_unit;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (is_angle(log, names[k])) remove_turns(turn, columns.col(static_cast<Index>(k)));
  }
  return columns;
}

}  // namespace dcnn::check
