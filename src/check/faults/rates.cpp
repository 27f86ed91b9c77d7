// SPDX-License-Identifier: Apache-2.0
#include "check/rates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/rows.h"
#include "core/elementary.h"
#include "data/held_rows.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr double kMovesToo = 0.1;  // of the fastest joint: one at rest trembles as others do

/// The first meaning is the declared one.
void compare_rates(const Eigen::MatrixXd& logged, const std::vector<RateMeaning>& meanings,
                   double independent, const std::string& channel, std::vector<Fault>& out) {
  const double declared = std::min(rate_cost(logged, meanings[0], independent),
                                   unrelated_cost(logged, meanings[0].rate, independent));
  Eigen::VectorXd gain(static_cast<Index>(meanings.size()) - 1);
  for (Index k = 0; k < gain.size(); ++k) {
    const RateMeaning& meaning = meanings[static_cast<std::size_t>(k) + 1];
    gain[k] = declared - rate_cost(logged, meaning, independent) - meaning.price;
  }
  Index best = 0;
  gain.maxCoeff(&best);
  const double log_odds =
      elementary::log(kFaultPrior / static_cast<double>(gain.size())) + log_sum(gain);
  const RateMeaning& meaning = meanings[static_cast<std::size_t>(best) + 1];
  double probability = probability_of_log_odds(log_odds);
  if (meaning.price > 0.0) {
    probability = std::min(probability, kFaultPrior / (kFaultPrior + kOtherShaft));
  }
  out.push_back(
      fault_of(rates_fault, probability, channel,
               channel + " is not the derivative of its position: it is " + meaning.words));
}

void find_joint_rates(const Evidence& e, std::vector<Fault>& out) {
  const Adopted& a = e.adopted;
  const std::vector<JointRate> joints = joint_rates(e.log, a.rows, a.reading);
  double fastest = 0.0;
  for (const JointRate& joint : joints) {
    fastest = std::max(fastest, joint.meanings[0].rate.norm());
  }
  const auto moves = [&](const JointRate& joint) {
    return joint.meanings[0].rate.norm() > kMovesToo * fastest;
  };
  for (const JointRate& joint : joints) {
    const Eigen::MatrixXd logged = joint.unit * joint.logged;
    std::vector<RateMeaning> meanings = joint.meanings;
    if (const auto scaled = scaled_rate(logged, meanings)) meanings.push_back(*scaled);
    for (const JointRate& other : joints) {
      if (other.channel == joint.channel || other.turns != joint.turns) continue;
      if (!moves(joint) || !moves(other)) continue;
      meanings.push_back({other.meanings[0].rate, 1.0, "that of " + other.position});
    }
    compare_rates(logged, meanings, a.independent, joint.channel, out);
  }
}

/// Rates of a wrist are in S; some log them in B.
void find_wrist_rates(const Evidence& e, const std::vector<std::string>& names, bool angular,
                      std::vector<Fault>& out) {
  const Adopted& a = e.adopted;
  if (!e.log.has_all(names) || (!angular && !a.motion.has_position)) return;
  const Eigen::Matrix3d R_ES = e.log.declared.model ? e.log.declared.model->R_ES()
                                                    : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const double dt = e.log.step * a.reading.clock;
  const auto n = static_cast<Index>(a.rows.centres.size());
  Eigen::MatrixXd in_sensor(n, 3), in_base(n, 3);
  for (Index i = 0; i < n; ++i) {
    const Eigen::Matrix3d R = a.motion.R[static_cast<std::size_t>(i)];
    const Eigen::Vector3d v =
        angular ? Eigen::Vector3d(R * a.motion.w.row(i).transpose() / dt)
                : Eigen::Vector3d(a.reading.position *
                                  (a.reading.position_axes * a.motion.velocity.row(i).transpose()) /
                                  dt);
    in_base.row(i) = v;
    in_sensor.row(i) = (R * R_ES).transpose() * v;
  }
  std::vector<RateMeaning> all = rate_meanings(in_sensor, angular, a.reading.angle == 1.0);
  all.push_back({in_base, 1.0, "in the base frame, not in the sensor's"});
  const double unit = angular ? a.reading.angle : a.reading.position;
  compare_rates(unit * a.rows.smoothed(e.log.block(names), a.rows.value), all, a.independent,
                names[0], out);
}

std::vector<Fault> find_rates(const Evidence& e) {
  std::vector<Fault> out;
  if (e.adopted.rows.half == 0 || e.adopted.rows.centres.size() < 12) return out;
  find_joint_rates(e, out);
  if (!e.adopted.compared) return out;
  find_wrist_rates(e, {"wx", "wy", "wz"}, true, out);
  find_wrist_rates(e, {"vx", "vy", "vz"}, false, out);
  return out;
}

}  // namespace

const FaultKind rates_fault{
    "rates", true, "convert the column, or leave it out: rates are then derived from the position",
    "", find_rates};

}  // namespace dcnn::check
