// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conceal/draws.h"
#include "conceal/faulty_alter.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;

Index some_row(const Table& t, Rng& rng) {
  const auto n = static_cast<double>(t.values.rows());
  return static_cast<Index>(n * rng.uniform(0.2, 0.7));
}

/// fx, fy or fz; of joints tau_2.
std::string some_measured(const Table& t, Rng& rng) {
  const auto name = one_of<std::string>(rng, {"fx", "fy", "fz"});
  return std::find(t.columns.begin(), t.columns.end(), name) != t.columns.end() ? name : "tau_2";
}

void keep_rows(Table& t, const std::vector<Index>& rows) {
  t.values = Eigen::MatrixXd(t.values(rows, Eigen::all));
}

void set_clock_back(Table& t, Rng& rng) {
  const Index at = some_row(t, rng), n = t.values.rows();
  column(t, "t").tail(n - at).array() -= 1.0;
}

void shake_clock(Table& t, Rng& rng) {
  for (double& time : column(t, "t")) time += 0.004 * 0.35 * rng.uniform(-1.0, 1.0);
}

void lose_stretches(Table& t, Rng& rng) {
  std::vector<Index> kept;
  const Index a = some_row(t, rng), length = 20 + static_cast<Index>(rng.below(200));
  for (Index i = 0; i < t.values.rows(); ++i) {
    if (i < a || i >= a + length) kept.push_back(i);
  }
  keep_rows(t, kept);
}

void hold(Table& t, Index every) {
  for (const char* name : {"fx", "fy", "fz"}) {
    auto x = column(t, name);
    for (Index i = 0; i < x.size(); ++i) x[i] = x[i - i % every];
  }
}

void freeze(Table& t, Rng& rng) {
  auto x = column(t, some_measured(t, rng));
  const Index a = some_row(t, rng), n = 200 + static_cast<Index>(rng.below(600));
  x.segment(a, std::min(n, x.size() - a)).setConstant(double(x[a]));
}

void add_spikes(Table& t, Rng& rng) {
  auto x = column(t, some_measured(t, rng));
  const int count = 3 + static_cast<int>(rng.below(8));
  const double size = (x.maxCoeff() - x.minCoeff()) * rng.uniform(0.5, 3.0);
  for (int k = 0; k < count; ++k) x[some_row(t, rng)] += rng.uniform() < 0.5 ? size : -size;
}

void drop_out(Table& t, Rng& rng) {
  const int count = 2 + static_cast<int>(rng.below(5));
  for (int k = 0; k < count; ++k) {
    const Index a = some_row(t, rng), n = 1 + static_cast<Index>(rng.below(12));
    for (const char* name : {"fx", "fy", "fz"}) column(t, name).segment(a, n).setZero();
  }
}

/// The axis that varies most, so that the limit is met.
std::string widest(Table& t) {
  std::string best = "fx";
  double most = 0.0;
  for (const char* name : {"fx", "fy", "fz"}) {
    const double range = column(t, name).maxCoeff() - column(t, name).minCoeff();
    if (range > most) most = range, best = name;
  }
  return best;
}

void saturate(Table& t, Rng& rng) {
  auto x = column(t, widest(t));
  const double low = x.minCoeff(), range = x.maxCoeff() - low;
  x = x.cwiseMin(low + rng.uniform(0.6, 0.85) * range);
}

void round_to(Table& t, double step) {
  for (const char* name : {"fx", "fy", "fz"}) {
    auto x = column(t, name);
    x = (x / step).array().round().matrix() * step;
  }
}

/// A 16-bit register of some counts to the newton whose zero the signal crosses.
void wrap_register(Table& t, Rng& rng) {
  const std::string name = widest(t);
  auto x = column(t, name);
  const double middle = x.mean() + rng.uniform(-0.1, 0.1) * (x.maxCoeff() - x.minCoeff());
  const double counts = 65536.0 / (1.2 * (x.maxCoeff() - x.minCoeff()));
  for (double& value : x)
    value = std::floor((value - middle) * counts) -
            65536.0 * std::floor((value - middle) * counts / 65536.0);
}

void count(Table& t, Rng& rng) {
  const double per_newton = logarithmic(rng, 100.0, 3000.0);
  for (const char* name : {"fx", "fy", "fz"})
    column(t, name) = (column(t, name) * per_newton).array().round().matrix();
}

/// Positive: the columns are late. Rows without a partner are cut.
void shift(Table& t, const std::vector<std::string>& names, Index rows) {
  const Index n = t.values.rows(), lag = std::abs(rows);
  for (const std::string& name : names) {
    const Eigen::VectorXd x = column(t, name);
    if (rows > 0) column(t, name).tail(n - lag) = x.head(n - lag);
    if (rows < 0) column(t, name).head(n - lag) = x.tail(n - lag);
  }
  t.values = Eigen::MatrixXd(t.values.middleRows(lag, n - 2 * lag));
}

void zero_at_start(Table& t) {
  for (const char* name : {"fx", "fy", "fz"})
    column(t, name).array() -= column(t, name).head(10).mean();
}

void touch(Table& t, Rng& rng) {
  const Index a = some_row(t, rng), n = 250 + static_cast<Index>(rng.below(500));
  const double sizes[3] = {rng.uniform(-4.0, 4.0), rng.uniform(-4.0, 4.0), 4.0};
  int k = 0;
  for (const char* name : {"fx", "fy", "fz"}) {
    auto x = column(t, name);
    x.segment(a, std::min(n, x.size() - a)).array() += sizes[k++];
  }
}

void wrap_joint(Table& t) {
  auto q = column(t, "q_1");
  const double range = q.maxCoeff() - q.minCoeff(), low = q.minCoeff();
  const double counts = 65536.0 / (0.8 * range);
  for (double& value : q) {
    const double place = std::floor((value - low) * counts);
    value = place - 65536.0 * std::floor(place / 65536.0);
  }
  remove(t, "qd_1");
}

void shift_torques(Table& t, Rng& rng) {
  const Index rows = 3 + static_cast<Index>(rng.below(6));
  shift(t, {"tau_1", "tau_2", "tau_3"}, rng.uniform() < 0.5 ? rows : -rows);
}

/// A joint's angle in (-pi, pi] that meets pi once.
void turn_once(Table& t, Rng& rng) {
  auto q = column(t, "q_1");
  const Index n = q.size(), at = some_row(t, rng);
  q.tail(n - at).array() -= 2.0 * std::numbers::pi;
}

void lose_single_torques(Table& t, Rng& rng) {
  const int count = 5 + static_cast<int>(rng.below(15));
  for (int k = 0; k < count; ++k) column(t, "tau_2")[some_row(t, rng)] = 0.0;
}

/// A motion of which a row every tenth of a second was kept, without its clock.
void keep_few_rows(Table& t, Rng& rng) {
  std::vector<Index> kept;
  const Index every = 12 + static_cast<Index>(rng.below(14));
  for (Index i = 0; i < t.values.rows(); i += every) kept.push_back(i);
  keep_rows(t, kept);
  remove(t, "t");
}

}  // namespace

const std::vector<FaultyKind>& faults_of_rows() {
  using C = CleanLog;
  static const std::vector<FaultyKind> kinds{
      {"clock_ms", "clock_unit", C::kEuler, [](Table& t, Rng&) { column(t, "t") *= 1e3; }},
      {"clock_us", "clock_unit", C::kEuler, [](Table& t, Rng&) { column(t, "t") *= 1e6; }},
      {"clock_ns", "clock_unit", C::kQuaternion,
       [](Table& t, Rng&) { column(t, "t") = (column(t, "t") * 1e9).array() + 1.7e18; }},
      {"joint_clock_ms", "clock_unit", C::kJoints, [](Table& t, Rng&) { column(t, "t") *= 1e3; }},
      {"clock_back", "clock_order", C::kEuler, set_clock_back},
      {"jitter", "jitter", C::kEuler, shake_clock},
      {"gaps", "gaps", C::kEuler, lose_stretches},
      {"held_2", "held", C::kEuler, [](Table& t, Rng&) { hold(t, 2); }},
      {"held_4", "held", C::kEuler, [](Table& t, Rng&) { hold(t, 4); }},
      {"frozen", "frozen", C::kEuler, freeze},
      {"joint_frozen", "frozen", C::kJoints, freeze},
      {"spikes", "spikes", C::kEuler, add_spikes},
      {"joint_spikes", "spikes", C::kJoints, add_spikes},
      {"dropouts", "dropouts", C::kEuler, drop_out},
      {"saturation", "saturation", C::kEuler, saturate},
      {"quantisation", "quantisation", C::kEuler, [](Table& t, Rng&) { round_to(t, 0.25); }},
      {"wrap", "wrap", C::kEuler, wrap_register},
      {"joint_wrap", "wrap", C::kJoints, [](Table& t, Rng&) { wrap_joint(t); }},
      {"counts", "counts", C::kEuler, count},
      {"delay_late", "delay", C::kBrisk,
       [](Table& t, Rng& rng) {
         shift(t, {"fx", "fy", "fz"}, 4 + static_cast<Index>(rng.below(7)));
       }},
      {"delay_early", "delay", C::kBrisk,
       [](Table& t, Rng& rng) {
         shift(t, {"fx", "fy", "fz"}, -4 - static_cast<Index>(rng.below(7)));
       }},
      {"joint_delay", "delay", C::kJoints, shift_torques},
      {"joint_turn", "wrap", C::kJoints, turn_once},
      {"joint_dropouts", "dropouts", C::kJoints, lose_single_torques},
      {"zeroed", "zeroed", C::kEuler, [](Table& t, Rng&) { zero_at_start(t); }},
      {"moving_rows", "moving_rows", C::kEuler, [](Table& t, Rng&) { remove(t, "t"); }},
      {"moving_rows_sparse", "moving_rows", C::kEuler, keep_few_rows},
      {"no_motion", "no_motion", C::kStill, [](Table&, Rng&) {}},
      {"contact", "contact", C::kEuler, touch},
      {"clean", "", C::kEuler, [](Table&, Rng&) {}},
      {"clean_quaternion", "", C::kQuaternion, [](Table&, Rng&) {}},
      {"clean_rates", "", C::kRates, [](Table&, Rng&) {}},
      {"clean_torque", "", C::kTorque, [](Table&, Rng&) {}},
      {"clean_static", "", C::kStatic, [](Table&, Rng&) {}},
      {"clean_motors", "", C::kMotors, [](Table&, Rng&) {}},
      {"clean_joints", "", C::kJoints, [](Table&, Rng&) {}},
  };
  return kinds;
}

}  // namespace dcnn::conceal
