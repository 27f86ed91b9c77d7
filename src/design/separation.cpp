// SPDX-License-Identifier: Apache-2.0
#include "design/separation.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/linear_algebra.h"

namespace dcnn::design {
namespace {

/// An orthonormal basis of the tangent, directions of less than 1e-5 of its largest left out.
Eigen::MatrixXd basis_of(const Prediction& a) {
  constexpr double kRank = 1e-5;
  if (a.tangent.cols() == 0) return a.tangent;
  const Spectrum s = spectrum_of(a.tangent.transpose() * a.tangent);
  Eigen::MatrixXd basis(a.tangent.rows(), 0);
  for (Index k = s.values.size() - 1; k >= 0; --k) {
    if (!(s.values(k) > kRank * kRank * s.values.tail(1)(0))) break;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = a.tangent * s.vectors.col(k) / std::sqrt(s.values(k));
  }
  return basis;
}

/// A motion at rest for three samples: what numbers a law refuses can be asked on it.
Motion resting() {
  Motion m;
  constexpr Index n = 3;
  m.t = Eigen::VectorXd::LinSpaced(n, 0.0, 0.02);
  m.dt = 0.01;
  m.R_BS.assign(n, Eigen::Matrix3d::Identity());
  m.euler = m.v_B = m.a_B = m.p_B = m.w_S = m.dw_S = Eigen::MatrixXd::Zero(n, 3);
  m.segments = {{0, n}};
  return m;
}

}  // namespace

Predictor::Predictor(const Question& question, double rate_hz)
    : question_(question), weight_(std::sqrt(question.sample_rate_hz / rate_hz)) {
  const Motion still = resting();
  for (const Hypothesis& one : question.hypotheses) {
    numbers_.emplace_back();
    for (std::size_t e = 0; e < one.effects.size(); ++e) {
      for (const auto& [name, value] : one.effects[e].parameters.items()) {
        if (!value.is_number()) continue;
        bool refused = false;
        if (value.get<double>() > 0.0) {
          std::vector<EffectSpec> alone{one.effects[e]};
          alone[0].parameters[name] = -value.get<double>();
          try {
            force_of(alone, still);
          } catch (const Error&) {
            refused = true;
          }
        }
        numbers_.back().push_back({e, name, refused});
      }
    }
  }
}

Eigen::VectorXd Predictor::force_of(const Effects& effects, const Motion& motion) const {
  const Wrench wrench = simulate({question_.tool, effects}, motion);
  const Index n = motion.samples();
  Eigen::VectorXd out(n * static_cast<Index>(question_.channels.size()));
  for (std::size_t j = 0; j < question_.channels.size(); ++j) {
    const int channel = question_.channels[j];
    const Eigen::MatrixXd& block = channel < 3 ? wrench.force : wrench.torque;
    require(block.rows() == n, Exit::kData, "model.json: has no inertia for torques");
    out.segment(static_cast<Index>(j) * n, n) =
        block.col(channel % 3) * (weight_ / question_.noise[j]);
  }
  return out;
}

void Predictor::move(const Number& number, double by, Effects& effects) {
  Json& value = effects[number.effect].parameters[number.name];
  const double before = value.get<double>();
  value = number.logarithmic ? before * elementary::exp(by) : before + by;
}

double Predictor::step_of(const Number& number, const Effects& effects) const {
  constexpr double kRelative = 1e-4, kLeast = 1e-3;  // of a number in SI units
  if (number.logarithmic) return kRelative;
  return kRelative *
         std::max(kLeast, std::abs(effects[number.effect].parameters[number.name].get<double>()));
}

Prediction Predictor::around(std::size_t k, const Effects& effects, const Motion& motion) const {
  Prediction out;
  out.force = force_of(effects, motion);
  out.tangent.resize(out.force.size(), static_cast<Index>(numbers_[k].size()));
  for (std::size_t i = 0; i < numbers_[k].size(); ++i) {
    const double h = step_of(numbers_[k][i], effects);
    Effects moved = effects;
    move(numbers_[k][i], h, moved);
    out.tangent.col(static_cast<Index>(i)) = (force_of(moved, motion) - out.force) / h;
  }
  return out;
}

Prediction Predictor::predict(std::size_t k, const Motion& motion) const {
  Prediction out = around(k, question_.hypotheses[k].effects, motion);
  for (Index i = 0; i < out.tangent.cols(); ++i) {
    const double length = out.tangent.col(i).norm();
    if (length > 0.0) out.tangent.col(i) /= length;
  }
  return out;
}

double Predictor::fitted_square(std::size_t k, const Motion& motion,
                                const Eigen::VectorXd& target) const {
  constexpr int kMostSteps = 30;
  constexpr double kEnough = 1e-6, kLargestStep = 1.0;  // relative fall; of a logarithm
  Effects best = question_.hypotheses[k].effects;
  double least = (target - force_of(best, motion)).squaredNorm(), damping = 1e-6;
  for (int step = 0; step < kMostSteps; ++step) {
    const Prediction now = around(k, best, motion);
    if (now.tangent.cols() == 0) break;
    const Eigen::MatrixXd gram = now.tangent.transpose() * now.tangent;
    const Eigen::VectorXd match = now.tangent.transpose() * (target - now.force);
    const double before = least;
    for (; damping < 1e6; damping *= 10.0) {
      Eigen::VectorXd by = solve_gram(gram, match, damping);
      Effects moved = best;
      for (std::size_t i = 0; i < numbers_[k].size(); ++i) {
        double& b = by(static_cast<Index>(i));
        if (numbers_[k][i].logarithmic) b = std::clamp(b, -kLargestStep, kLargestStep);
        move(numbers_[k][i], b, moved);
      }
      try {
        const double square = (target - force_of(moved, motion)).squaredNorm();
        if (!(square < least)) continue;
        least = square;
        best = moved;
        damping = std::max(1e-9, damping * 0.1);
        break;
      } catch (const Error&) {
        continue;  // numbers that the law refuses
      }
    }
    if (!(before - least > kEnough * before)) break;
  }
  return least;
}

double separation(const Prediction& a, const Prediction& b) {
  const Eigen::VectorXd difference = a.force - b.force;
  const double whole = difference.squaredNorm();
  if (b.tangent.cols() == 0 || whole == 0.0) return whole;
  constexpr double kRidge = 1e-10;
  const Eigen::VectorXd match = b.tangent.transpose() * difference;
  const Eigen::VectorXd x = solve_gram(b.tangent.transpose() * b.tangent, match, kRidge);
  return std::max(0.0, whole - match.dot(x));
}

double shared_dimension(const Prediction& a, const Prediction& b) {
  return (basis_of(a).transpose() * basis_of(b)).squaredNorm();
}

Eigen::Index dimension(const Prediction& a) { return basis_of(a).cols(); }

}  // namespace dcnn::design
