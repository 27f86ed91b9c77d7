// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/budget_columns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace dcnn {
namespace {

constexpr Index kMostRows = 30000;
constexpr int kWaves = 6;                            // of the clock
const std::vector<double> kReaches{1e-3, 5e-3};      // m, of bristles
const std::vector<double> kAngleReaches{0.05, 0.2};  // rad, of cables

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// A velocity of the coarse motion: along a sensor's axis, along one of the base, or of turning.
Vector velocity(const Motion& motion, int axis, char kind) {
  if (kind == 'w') return motion.w_S.col(axis);
  if (motion.v_B.rows() != motion.samples()) return Vector::Zero(motion.samples());
  if (kind == 'b') return motion.v_B.col(axis);
  Vector v(motion.samples());
  for (Index i = 0; i < v.size(); ++i) {
    v(i) = motion.R_BS[static_cast<std::size_t>(i)].col(axis).dot(motion.v_B.row(i).transpose());
  }
  return v;
}

double rms(const Case& study, int axis, char kind) {
  double square = 0.0, count = 0.0;
  for (const Log& log : study.logs) {
    const Vector v = velocity(log.motion, axis, kind);
    square += v.squaredNorm();
    count += static_cast<double>(v.size());
  }
  return std::sqrt(square / std::max(1.0, count));
}

/// Deflection dz = dq - abs(dq) z/reach of bristles (Dahl 1968) that a motion drags along.
Vector dragged(const Vector& rate, double dt, double reach) {
  Vector z = Vector::Zero(rate.size());
  for (Index i = 1; i < z.size(); ++i) {
    const double way = rate(i) * dt;
    z(i) = std::copysign(reach, way) +
           (z(i - 1) - std::copysign(reach, way)) * elementary::exp(-std::abs(way) / reach);
  }
  return z / reach;
}

/// One vector a recording.
template <class Value>
std::vector<Vector> of_logs(const BudgetColumns& columns, const Value& value) {
  std::vector<Vector> list;
  for (const Log& log : columns.study().logs) list.emplace_back(value(log.motion));
  return list;
}

}  // namespace

BudgetColumns::BudgetColumns(const Setting& setting) : setting_(setting) {
  const Index rows = setting.whitener.rows(), step = (rows + kMostRows - 1) / kMostRows;
  for (Index row = 0; row < rows; ++row) {
    if (setting.mask(row) != 0.0 && row % step == 0) kept_.push_back(row);
  }
}

void BudgetColumns::add_whitened(const Matrix& columns) {
  const Matrix own = columns(kept_, Eigen::all);
  for (Index k = 0; k < own.cols(); ++k) {
    const double norm = own.col(k).norm();
    if (!(norm > 0.0) || !std::isfinite(norm)) continue;
    all_.conservativeResize(own.rows(), all_.cols() + 1);
    all_.rightCols(1) = own.col(k) / norm;
  }
}

void BudgetColumns::add(const Signals& signals) { add_whitened(setting_.coarse_whitener(signals)); }

void BudgetColumns::add_along(int axis, bool base, const std::vector<Vector>& size) {
  Signals signals;
  for (std::size_t k = 0; k < size.size(); ++k) {
    const Motion& motion = study().logs[k].motion;
    Matrix s = Matrix::Zero(motion.samples(), study().channel_count());
    for (Index j = 0; j < s.cols(); ++j) {
      const int channel = study().channels[static_cast<std::size_t>(j)];
      if (channel > 2) continue;
      if (!base && channel == axis) s.col(j) = size[k];
      for (Index i = 0; base && i < s.rows(); ++i) {
        s(i, j) = size[k](i) * motion.R_BS[static_cast<std::size_t>(i)](axis, channel);
      }
    }
    signals.push_back(std::move(s));
  }
  add(signals);
}

void BudgetColumns::add_by_channel(const std::vector<Vector>& size) {
  for (Index j = 0; j < study().channel_count(); ++j) {
    Signals signals;
    for (const Vector& part : size) {
      signals.emplace_back(Matrix::Zero(part.size(), study().channel_count()));
      signals.back().col(j) = part;
    }
    add(signals);
  }
}

void add_state(BudgetColumns& columns) {
  for (const char kind : {'s', 'b', 'w'}) {
    for (int axis = 0; axis < 3; ++axis) {
      const double small = 0.1 * rms(columns.study(), axis, kind);
      if (small == 0.0) continue;
      const auto along = [&](const auto& law) {
        columns.add_along(axis, kind == 'b', of_logs(columns, [&](const Motion& motion) -> Vector {
                            return law(velocity(motion, axis, kind).array());
                          }));
      };
      along([&](const auto& v) -> Vector { return elementary::tanh(v / small); });
      along([&](const auto& v) -> Vector { return v; });
      along([&](const auto& v) -> Vector { return v.abs() * v; });
    }
  }
  for (Index angle = 0; angle < 3; ++angle) {
    const auto of_angle = [&](const auto& law) {
      columns.add_by_channel(of_logs(columns, [&](const Motion& motion) -> Vector {
        return law(motion.euler.col(angle).array());
      }));
    };
    of_angle([](const auto& q) -> Vector { return elementary::sin(q); });
    of_angle([](const auto& q) -> Vector { return elementary::cos(q); });
    of_angle([](const auto& q) -> Vector { return q; });
  }
}

void add_memory(BudgetColumns& columns, const Signals& prediction) {
  Signals slope, bend;
  for (const Matrix& f : prediction) {
    slope.emplace_back(Matrix::Zero(f.rows(), f.cols()));
    bend.emplace_back(Matrix::Zero(f.rows(), f.cols()));
    for (Index i = 1; i + 1 < f.rows(); ++i) {
      slope.back().row(i) = f.row(i + 1) - f.row(i - 1);
      bend.back().row(i) = f.row(i + 1) - 2.0 * f.row(i) + f.row(i - 1);
    }
  }
  columns.add(slope);
  columns.add(bend);
  for (const char kind : {'s', 'b', 'w'}) {
    for (int axis = 0; axis < 3; ++axis) {
      if (rms(columns.study(), axis, kind) == 0.0) continue;
      for (const double reach : kind == 'w' ? kAngleReaches : kReaches) {
        columns.add_along(axis, kind == 'b', of_logs(columns, [&](const Motion& motion) {
                            return dragged(velocity(motion, axis, kind), motion.dt, reach);
                          }));
      }
    }
  }
  for (Index angle = 0; angle < 3; ++angle) {
    columns.add_by_channel(of_logs(columns, [&](const Motion& motion) {
      Vector rate = Vector::Zero(motion.samples());
      const auto q = motion.euler.col(angle);
      for (Index i = 1; i < rate.size(); ++i) rate(i) = (q(i) - q(i - 1)) / motion.dt;
      return dragged(rate, motion.dt, kAngleReaches.back());
    }));
  }
}

void add_clock(BudgetColumns& columns) {
  const std::vector<Log>& logs = columns.study().logs;
  double begin = 1e300, end = -1e300;
  for (const Log& log : logs) {
    begin = std::min(begin, log.motion.t(0));
    end = std::max(end, log.motion.t(log.motion.samples() - 1));
  }
  for (int wave = 1; wave <= kWaves; ++wave) {
    columns.add_by_channel(of_logs(columns, [&](const Motion& motion) -> Vector {
      return elementary::cos(wave * std::numbers::pi * (motion.t.array() - begin) / (end - begin));
    }));
  }
  const bool warm = std::all_of(logs.begin(), logs.end(), [](const Log& log) {
    return log.motion.temperature.size() == log.motion.samples();
  });
  if (warm) {
    columns.add_by_channel(
        of_logs(columns, [](const Motion& motion) { return motion.temperature; }));
  }
}

void add_events(BudgetColumns& columns, const Json& segments) {
  for (const Json& segment : segments) {
    const double begin = segment["interval_s"][0].get<double>();
    const double end = segment["interval_s"][1].get<double>();
    const bool one = segment.contains("recording");
    for (int axis = 0; axis < 3; ++axis) {
      columns.add_along(
          axis, true, of_logs(columns, [&](const Motion& motion) -> Vector {
            if (one && segment["recording"].get<std::string>() != motion.recording) {
              return Vector::Zero(motion.samples());
            }
            return (motion.t.array() >= begin && motion.t.array() <= end).cast<double>();
          }));
    }
  }
}

}  // namespace dcnn
