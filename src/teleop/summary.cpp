// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "dcnn/teleop/teleop.h"

namespace dcnn {
namespace {

constexpr double kContact = 0.05;  // N, above which there is contact
constexpr double kSettled = 1.0;   // s after the start
constexpr Index kMostBounces = 2;

/// Root mean square and largest size of what it was given.
struct Size {
  double sum = 0.0, most = 0.0;
  Index count = 0;
  void add(double value) {
    sum += value * value;
    most = std::max(most, std::abs(value));
    ++count;
  }
  Json rms() const { return count ? Json(std::sqrt(sum / static_cast<double>(count))) : Json(); }
  Json maximum() const { return count ? Json(most) : Json(); }
};

/// Times that the slave lost the wall and was back within half a second: one contact has none.
Index bounces(const TeleopTrace& trace) {
  constexpr double kSoon = 0.5;  // s
  const auto touching = [&](Index k) { return trace.contact(k, 2) > kContact; };
  Index count = 0;
  double lost = -INFINITY;
  for (Index k = 1; k < trace.t.size(); ++k) {
    if (touching(k - 1) && !touching(k)) lost = trace.t[k];
    count += touching(k) && !touching(k - 1) && trace.t[k] - lost < kSoon;
  }
  return count;
}

}  // namespace

Json summarise(const TeleopTrace& trace, const TeleopConfig& config, const std::string& name) {
  const Eigen::VectorXd force = trace.contact.col(2);
  const Eigen::MatrixXd error = trace.slave - config.position_scale * trace.master;
  Size free, contact, handle, norm;
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();
  Index first = -1, last = -1;
  for (Index k = 0; k < trace.t.size(); ++k) {
    const bool touching = force[k] > kContact;
    if (touching) {
      first = first < 0 ? k : first;
      last = k;
      contact.add(error(k, 2));
    } else if (trace.t[k] > kSettled) {
      free.add(error(k, 2));
      handle.add(trace.felt.row(k).norm());
      drift += (trace.master.row(k) - trace.intended.row(k)).transpose();
    }
    if (trace.t[k] > kSettled) norm.add(error.row(k).norm());
  }
  if (handle.count > 0) drift /= static_cast<double>(handle.count);
  Json json = {{"name", name}, {"contact_interval_s", Json()}};
  if (first >= 0) json["contact_interval_s"] = {trace.t[first], trace.t[last]};
  json["force_max_n"] = force.maxCoeff();
  json["free_error_rms_m"] = free.rms();
  json["free_error_max_m"] = free.maximum();
  json["contact_error_rms_m"] = contact.rms();
  json["contact_error_max_m"] = contact.maximum();
  json["handle_force_free_rms_n"] = handle.rms();
  json["master_drift_m"] = drift.norm();
  json["error_norm_rms_m"] = norm.rms();
  json["estimate_rms_n"] = std::sqrt((trace.estimated - trace.contact).squaredNorm() /
                                     static_cast<double>(3 * trace.t.size()));
  json["bounces"] = bounces(trace);
  json["stable"] = bounces(trace) <= kMostBounces;
  json["energy_min_j"] = trace.energy.minCoeff();
  json["energy_dissipated_j"] = trace.dissipated;
  return json;
}

}  // namespace dcnn
