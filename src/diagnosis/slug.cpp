// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/slug.h"

#include <cmath>

namespace dcnn {
namespace {

/// Appends the impacts of one way from stop to stop that begins at sample `from`, with its
/// rebounds; false where the field turns back before the load arrives.
bool slide(const Eigen::VectorXd& field, const Slug& slug, Index from, double dt, std::size_t log,
           std::vector<Impact>& impacts) {
  constexpr double kRest = 0.02;  // m/s
  const double sense = std::copysign(1.0, field(from));
  double way = 0.0, speed = 0.0;
  bool arrived = false;
  for (Index k = from; k < field.size(); ++k) {
    speed += (sense * field(k) - std::copysign(slug.grip, speed)) * dt;
    way += speed * dt;
    if (way < 0.0 || (!arrived && speed < 0.0)) break;
    if (way < slug.gap) continue;
    arrived = true;
    impacts.push_back({log, from, k, sense * (1.0 + slug.rebound) * speed});
    speed *= -slug.rebound;
    way = slug.gap;
    if (speed > -kRest) break;
  }
  return arrived;
}

}  // namespace

void AxisField::leave(double grip) {
  leaves.clear();
  double side = 0.0;
  for (Index i = 0; i < along.size(); ++i) {
    const double now = std::abs(along(i)) <= grip ? 0.0 : along(i);
    if (now != 0.0 && now * side <= 0.0) leaves.push_back(i);
    side = now;
  }
}

std::vector<Impact> impacts_of(const std::vector<AxisField>& fields, const Slug& slug, double dt) {
  std::vector<Impact> impacts;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const Eigen::VectorXd& field = fields[k].along;
    double side = field.size() > 0 ? field(0) : 0.0;
    for (const Index i : fields[k].leaves) {
      if (side * field(i) <= 0.0 && slide(field, slug, i, dt, k, impacts)) side = field(i);
    }
  }
  return impacts;
}

}  // namespace dcnn
