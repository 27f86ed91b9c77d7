// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "check/axes.h"
#include "check/priors.h"
#include "check/statistics.h"
#include "check/torque.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;

/// As they are called, or turned, scaled and framed as the forces are found to be.
std::vector<TorqueReading> right_readings(const Reading& force) {
  std::vector<TorqueReading> right(1);
  TorqueReading like_force;
  like_force.axes = force.force_axes;
  like_force.unit = force.force;
  like_force.in_base = force.force_in_base;
  const bool same = like_force.axes.isIdentity(1e-12) && like_force.unit == 1.0;
  if (!same || like_force.in_base) right.push_back(like_force);
  for (TorqueReading& reading : right) reading.prior = 1.0 / static_cast<double>(right.size());
  return right;
}

void add_units(const TorqueReading& right, std::vector<TorqueReading>& out) {
  const struct {
    double unit;
    const char* name;
  } kUnits[] = {{1e-3, "millinewton metres (N mm)"},
                {1e-2, "newton centimetres"},
                {9.80665, "kilogram metres (kgf m)"},
                {9.80665e-2, "kilogram centimetres (kgf cm)"},
                {0.1129848, "pound inches (lbf in)"}};
  for (const auto& [unit, name] : kUnits) {
    TorqueReading reading = right;
    reading.kind = &torque_unit_fault;
    reading.unit *= unit;
    reading.words = std::string("torques are in ") + name + ", not in newton metres";
    out.push_back(std::move(reading));
  }
}

void add_frame(const TorqueReading& right, std::vector<TorqueReading>& out) {
  TorqueReading reading = right;
  reading.kind = &torque_frame_fault;
  reading.in_base = !right.in_base;
  reading.words = right.in_base
                      ? "torques are in the sensor's frame, unlike the forces"
                      : "torques are in the robot's base frame, not in the sensor's as the forces";
  out.push_back(std::move(reading));
}

/// The signed permutations but for the identity.
void add_orders(const TorqueReading& right, std::vector<TorqueReading>& out) {
  for (const Matrix3d& P : signed_permutations()) {
    const bool straight = P.isDiagonal(), all = straight && P.trace() < -2.5,
               one = straight && std::abs(P.trace() - 1.0) < 0.5;
    if (straight && P.trace() > 2.5) continue;
    TorqueReading reading = right;
    reading.axes = P * right.axes;
    reading.kind = all || one ? &torque_sign_fault : &torque_axes_fault;
    if (one) reading.channel = P(0, 0) < 0.0 ? "tx" : P(1, 1) < 0.0 ? "ty" : "tz";
    reading.words = all   ? "torques have the other sign than the forces: they are the reaction"
                    : one ? reading.channel + " has the wrong sign"
                          : "the torque's axes are not the force's: " + axes_words(P, "t");
    out.push_back(std::move(reading));
  }
}

std::vector<TorqueReading> readings_of(const Reading& force) {
  std::vector<TorqueReading> all = right_readings(force), faulty;
  for (const TorqueReading& right : all) {
    add_units(right, faulty);
    add_frame(right, faulty);
    add_orders(right, faulty);
  }
  std::map<const FaultKind*, double> variants;
  for (const TorqueReading& reading : faulty) variants[reading.kind] += 1.0;
  for (TorqueReading& reading : faulty) {
    reading.prior = kFaultPrior / variants[reading.kind];
    if (reading.channel.empty()) reading.channel = "tx";
    all.push_back(std::move(reading));
  }
  return all;
}

/// Of all kinds that readings of the torque belong to.
std::vector<Fault> find_torques(const Evidence& e) {
  if (!can_fit_torque(e)) return {};
  const TorqueDesign design(e);
  const std::vector<TorqueReading> readings = readings_of(e.adopted.reading);
  Eigen::VectorXd weight(static_cast<Index>(readings.size()));
  for (Index k = 0; k < weight.size(); ++k) {
    weight[k] = design.log_weight(readings[static_cast<std::size_t>(k)]);
  }
  if (!weight.allFinite()) return {};
  Index best = 0;
  weight.maxCoeff(&best);
  const Eigen::VectorXd share = shares_of(weight);
  // Where no rigid tool explains the torque, no reading of it is told.
  if (design.foreign_share(readings[static_cast<std::size_t>(best)]) > kMostForeign) return {};
  struct Kind {
    double probability = 0.0, most = -1.0;
    const TorqueReading* likeliest = nullptr;
  };
  std::map<std::string, Kind> kinds;
  double right = 0.0;  // of the likeliest reading without a fault
  for (Index k = 0; k < share.size(); ++k) {
    const TorqueReading& reading = readings[static_cast<std::size_t>(k)];
    if (reading.kind == nullptr) right = std::max(right, share[k]);
    if (reading.kind == nullptr) continue;
    Kind& kind = kinds[reading.kind->id];
    kind.probability += share[k];
    if (share[k] > kind.most) kind.most = share[k], kind.likeliest = &reading;
  }
  std::vector<Fault> out;
  for (const auto& [id, kind] : kinds) {
    const TorqueReading& reading = *kind.likeliest;
    // Many readings of a kind, each less likely than none, are told apart by nothing: the words are
    // about one of them.
    const double told = kind.most < right ? kind.most : kind.probability;
    out.push_back(fault_of(*reading.kind, told, reading.channel, reading.words));
    if (reading.kind == &torque_unit_fault) out.back().remedy = "write torques in newton metres";
  }
  return out;
}

}  // namespace

const FaultKind torque_axes_fault{
    "torque_axes", true, "rename the columns of the torque", "", find_torques, nullptr, true};

}  // namespace dcnn::check
