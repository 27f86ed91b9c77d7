// SPDX-License-Identifier: Apache-2.0
#include "identification/arm_fit.h"

#include <algorithm>
#include <cmath>

#include "core/linear_algebra.h"
#include "identification/arm_terms.h"

namespace dcnn::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// What is known of a link before: without a description its mass and reach alone, with one its
// share.
constexpr double kLinkMass = 30.0, kLinkReach = 0.5;        // kg, m
constexpr double kDescribed = 0.3, kLeastDescribed = 0.05;  // of the described; kg
constexpr double kDescribedReach = 0.1;                     // m, beside its centre's distance
constexpr double kDriveGain = 0.3;                          // of one
constexpr double kWideDrive = 1e3;  // times the joint's torque, per unit of a drive's term
constexpr int kRounds = 4;
const std::vector<double> kPaths{1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2};  // rad or m
const std::vector<double> kCreeps{0.0, 0.1, 0.3, 1.0, 3.0, 10.0};      // s; 0: none
const std::vector<DriveTerm> kMore{DriveTerm::kLoad, DriveTerm::kQuadratic, DriveTerm::kStribeck};

class ArmFitter {
 public:
  ArmFitter(const JointChain& chain, std::vector<ArmLog>& logs, bool drive_gains)
      : chain_(chain), logs_(logs), joints_(static_cast<Index>(chain.joints.size())) {
    fit_.drives.resize(chain.joints.size());
    // Friction and rotors are not seen where no joint moves.
    at_rest_ =
        std::all_of(logs.begin(), logs.end(), [](const ArmLog& log) { return log.clock.at_rest; });
    for (Drive& drive : fit_.drives) {
      if (at_rest_) drive.terms = {DriveTerm::kOffset};
    }
    for (std::size_t j = 0; drive_gains && j < fit_.drives.size(); ++j) {
      fit_.drives[j].terms.push_back(DriveTerm::kGain);
    }
    fit_.residual_rms = VectorXd::Ones(joints_);
    fit_.correlated = VectorXd::Ones(joints_);
    set_slow_speeds();
  }

  ArmFit run() {
    refine();
    choose_terms();
    refine();
    solve();
    return std::move(fit_);
  }

 private:
  void refine() {
    for (int round = 0; round < kRounds; ++round) {
      solve();
      if (round % 2 == 0 && !at_rest_) choose_paths();  // each costs a search over two shapes
    }
  }

  void set_slow_speeds() {
    for (Index j = 0; j < joints_; ++j) {
      double square = 0.0, rows = 0.0;
      for (const ArmLog& log : logs_) {
        square += log.v.col(j).squaredNorm();
        rows += static_cast<double>(log.v.rows());
      }
      fit_.drives[static_cast<std::size_t>(j)].slow =
          std::max(1e-6, 0.5 * std::sqrt(square / rows));
    }
  }

  /// Links, payload, drives: what comes first stays in its place when terms are added.
  void lay_out() {
    const bool loaded =
        std::any_of(logs_.begin(), logs_.end(), [](const ArmLog& log) { return log.loaded; });
    size_ = 10 * joints_;
    fit_.payload = loaded ? size_ : -1;
    if (loaded) size_ += 10;
    fit_.first.clear();
    for (const Drive& drive : fit_.drives) {
      fit_.first.push_back(size_);
      size_ += static_cast<Index>(drive.terms.size());
    }
  }

  /// What is known before: mean and deviation of every parameter.
  std::pair<VectorXd, VectorXd> prior() const {
    VectorXd mean = VectorXd::Zero(size_), sd = VectorXd::Constant(size_, 1.0);
    const auto body_sd = [](double mass, double reach) {
      BodyVector s;
      s << mass, BodyVector::Constant(mass * reach * reach).head<9>();
      s.segment<3>(1).setConstant(mass * reach);
      return s;
    };
    for (std::size_t j = 0; j < chain_.joints.size(); ++j) {
      const auto at = 10 * static_cast<Index>(j);
      const auto& body = chain_.joints[j].body;
      sd.segment(at, 10) = body_sd(kLinkMass, kLinkReach);
      if (!body) continue;
      mean.segment(at, 10) = *body;
      const double reach = body->segment<3>(1).norm() / (*body)[0] + kDescribedReach;
      sd.segment(at, 10) = body_sd(kDescribed * (*body)[0] + kLeastDescribed, reach);
    }
    for (std::size_t j = 0; j < fit_.drives.size(); ++j) {
      const Drive& drive = fit_.drives[j];
      for (std::size_t t = 0; t < drive.terms.size(); ++t) {
        sd[fit_.first[j] + static_cast<Index>(t)] =
            drive.terms[t] == DriveTerm::kGain ? kDriveGain : kWideDrive * scale(j);
      }
    }
    if (fit_.payload >= 0) sd.segment(fit_.payload, 10) = body_sd(kLinkMass, kLinkReach);
    return {mean, sd};
  }

  double scale(std::size_t j) const {
    double most = 1e-9;
    for (const ArmLog& log : logs_) {
      most = std::max(most, log.torque.col(static_cast<Index>(j)).cwiseAbs().maxCoeff());
    }
    return most;
  }

  /// The rigid body's torque of one joint in one log, by the present estimate.
  VectorXd rigid_torque(const ArmLog& log, std::size_t j) const {
    if (fit_.x.size() == 0) return VectorXd::Zero(log.torque.rows());
    VectorXd torque = log.rigid[j] * fit_.x.head(10 * joints_);
    if (log.loaded) {
      torque += payload_columns(chain_, log, j) * fit_.x.segment(fit_.payload, 10);
    }
    return fit_.drives[j].gain * torque;
  }

  MatrixXd columns(const ArmLog& log, std::size_t j, const VectorXd& rigid) const {
    const Drive& drive = fit_.drives[j];
    MatrixXd A = MatrixXd::Zero(log.torque.rows(), size_);
    A.leftCols(10 * joints_) = drive.gain * log.rigid[j];
    A.middleCols(fit_.first[j], static_cast<Index>(drive.terms.size())) =
        drive_columns(log, static_cast<Index>(j), drive, rigid);
    if (log.loaded) {
      A.middleCols(fit_.payload, 10) = drive.gain * payload_columns(chain_, log, j);
    }
    return A;
  }

  /// A joint's rows by what it leaves of them, and not by how long that stays: what a wrong model
  /// leaves stays long, and would be left to grow.
  double weight(Index joint) const {
    return 1.0 / (fit_.residual_rms[joint] * fit_.residual_rms[joint] * fit_.correlated.mean());
  }

  void solve() {
    lay_out();
    const auto [mean, sd] = prior();
    // In units of the prior's deviation.
    MatrixXd H = MatrixXd::Identity(size_, size_), spread = H;
    VectorXd g = VectorXd::Zero(size_);
    std::vector<std::vector<MatrixXd>> all(logs_.size());
    for (std::size_t k = 0; k < logs_.size(); ++k) {
      for (std::size_t j = 0; j < fit_.drives.size(); ++j) {
        const VectorXd rigid = rigid_torque(logs_[k], j);
        all[k].push_back(columns(logs_[k], j, rigid) * sd.asDiagonal());
        const auto joint = static_cast<Index>(j);
        const MatrixXd& A = all[k].back();
        const VectorXd y = logs_[k].torque.col(joint) - A * mean.cwiseQuotient(sd);
        const MatrixXd gram = weight(joint) * A.transpose() * A;
        H += gram;
        spread += fit_.correlated[joint] / fit_.correlated.mean() * gram;
        g += weight(joint) * A.transpose() * y;
      }
    }
    const VectorXd u = solve_symmetric(H, g);
    fit_.x = mean + sd.cwiseProduct(u);
    fit_.prior_deviation = sd;
    const MatrixXd inverse = solve_symmetric(H, MatrixXd::Identity(size_, size_));
    fit_.covariance = sd.asDiagonal() * (inverse * spread * inverse) * sd.asDiagonal();
    fit_.deviation = fit_.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    set_residuals(all, fit_.x.cwiseQuotient(sd), inverse);
    take_gains();
  }

  /// A joint's variance by the degrees of freedom that its rows keep: their number, less that of
  /// the parameters they decide (the trace of the hat matrix), of which each takes as many rows as
  /// count as one.
  void set_residuals(const std::vector<std::vector<MatrixXd>>& all, const VectorXd& u,
                     const MatrixXd& inverse) {
    const double common = fit_.correlated.mean();
    VectorXd correlated(joints_);
    for (Index j = 0; j < joints_; ++j) {
      double square = 0.0, rows = 0.0, correlation = 0.0, decided = 0.0;
      for (std::size_t k = 0; k < logs_.size(); ++k) {
        const MatrixXd& A = all[k][static_cast<std::size_t>(j)];
        const VectorXd r = logs_[k].torque.col(j) - A * u;
        const auto n = static_cast<double>(r.size());
        square += r.squaredNorm();
        rows += n;
        correlation += correlated_rows(logs_[k], r) * n;
        decided += weight(j) * (A * inverse).cwiseProduct(A).sum();
      }
      const double freedom = std::max(1.0, rows - common * decided);
      fit_.residual_rms[j] = std::max(std::sqrt(square / freedom), 1e-12);
      correlated[j] = correlation / rows;
    }
    fit_.correlated = correlated;
  }

  /// A gain that was found is taken into the columns, so that the next round starts from it.
  void take_gains() {
    for (std::size_t j = 0; j < fit_.drives.size(); ++j) {
      Drive& drive = fit_.drives[j];
      for (std::size_t t = 0; t < drive.terms.size(); ++t) {
        if (drive.terms[t] != DriveTerm::kGain) continue;
        double& found = fit_.x[fit_.first[j] + static_cast<Index>(t)];
        drive.gain *= 1.0 + found;
        found = 0.0;
      }
    }
  }

  /// Sum of squares that a joint's drive leaves of what the rigid body does not take; and rows.
  double drive_residual(std::size_t j, const Drive& drive) const {
    MatrixXd gram;
    VectorXd match;
    double square = 0.0;
    for (const ArmLog& log : logs_) {
      const VectorXd rigid = rigid_torque(log, j);
      const MatrixXd E = drive_columns(log, static_cast<Index>(j), drive, rigid);
      const VectorXd y = log.torque.col(static_cast<Index>(j)) - rigid;
      if (gram.size() == 0) {
        gram = MatrixXd::Zero(E.cols(), E.cols());
        match = VectorXd::Zero(E.cols());
      }
      gram += E.transpose() * E;
      match += E.transpose() * y;
      square += y.squaredNorm();
    }
    return std::max(square - match.dot(solve_gram(gram, match, 1e-10).col(0)), 1e-300);
  }

  void choose_paths() {
    for (std::size_t j = 0; j < fit_.drives.size(); ++j) {
      Drive best = fit_.drives[j], trial = best;
      double least = INFINITY;
      // Both together: at rest a short path that the encoder's steps run through looks like creep.
      for (const double path : kPaths) {
        for (const double creep : kCreeps) {
          trial.presliding = path;
          trial.creep_s = creep;
          const double left = drive_residual(j, trial);
          if (left < least) least = left, best = trial;
        }
      }
      fit_.drives[j] = best;
    }
  }

  /// Adds terms while Schwarz's criterion, with the rows that count, gains.
  void choose_terms() {
    if (at_rest_) return;
    for (std::size_t j = 0; j < fit_.drives.size(); ++j) {
      double rows = 0.0;
      for (const ArmLog& log : logs_) rows += static_cast<double>(log.torque.rows());
      rows /= fit_.correlated[static_cast<Index>(j)];
      for (const DriveTerm term : kMore) {
        Drive more = fit_.drives[j];
        more.terms.push_back(term);
        const double gain =
            rows * std::log(drive_residual(j, fit_.drives[j]) / drive_residual(j, more));
        if (gain > std::log(rows) + 2.0 * std::log(static_cast<double>(kMore.size()))) {
          fit_.drives[j] = more;
        }
      }
    }
  }

  const JointChain& chain_;
  std::vector<ArmLog>& logs_;
  Index joints_, size_ = 0;
  bool at_rest_ = false;
  ArmFit fit_;
};

}  // namespace

ArmFit fit_arm(const JointChain& chain, std::vector<ArmLog>& logs, bool drive_gains) {
  return ArmFitter(chain, logs, drive_gains).run();
}

}  // namespace dcnn::identification
