// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/arm_sums.h"

#include <algorithm>
#include <cmath>

#include "core/linear_algebra.h"
#include "diagnosis/evidence/priors.h"

namespace dcnn {
namespace {

constexpr double kSharedBaseRidge = 1e-9;
constexpr int kReweightings = 4;

}  // namespace

ArmSums::Piece ArmSums::as_left_out(const Piece& piece, Index first,
                                    const Eigen::MatrixXd& friction) {
  const Eigen::MatrixXd told = piece.gram.middleRows(first, kOwnFriction);
  const Eigen::VectorXd match = piece.match.segment(first, kOwnFriction);
  const Eigen::MatrixXd moved = solve_gram(friction, told, kSharedBaseRidge);
  const Eigen::VectorXd taken = solve_gram(friction, match, kSharedBaseRidge);
  return {piece.gram - told.transpose() * moved, piece.match - moved.transpose() * match,
          piece.square - match.dot(taken), piece.rows};
}

ArmSums::ArmSums(const std::vector<JointRows>& joints) : links_(joints.front().arm.cols()) {
  for (const JointRows& rows : joints) {
    for (const Index p : rows.piece) pieces_ = std::max(pieces_, p + 1);
  }
  for (const JointRows& rows : joints) {
    Eigen::MatrixXd A(rows.arm.rows(), rows.arm.cols() + rows.own.cols());
    A << rows.arm, rows.own;
    std::vector<Piece> sums;
    for (Index p = 0; p < pieces_; ++p) {
      std::vector<Index> list;
      for (std::size_t i = 0; i < rows.piece.size(); ++i) {
        if (rows.piece[i] == p) list.push_back(static_cast<Index>(i));
      }
      const Eigen::MatrixXd part = A(list, Eigen::all);
      const Eigen::VectorXd y = rows.target(list);
      sums.push_back({part.transpose() * part, part.transpose() * y, y.squaredNorm(),
                      static_cast<double>(list.size())});
    }
    Eigen::MatrixXd friction = Eigen::MatrixXd::Zero(kOwnFriction, kOwnFriction);
    for (const Piece& piece : sums) {
      friction += piece.gram.block(links_, links_, kOwnFriction, kOwnFriction);
    }
    std::vector<Piece> left_out;
    for (const Piece& piece : sums) left_out.push_back(as_left_out(piece, links_, friction));
    sums_.push_back(std::move(sums));
    left_out_.push_back(std::move(left_out));
  }
}

ArmRegression::ArmRegression(const ArmSums& sums, ArmModel model)
    : sums_(sums),
      shared_(model.shared.cols()),
      variance_(Eigen::VectorXd::Ones(static_cast<Index>(sums.joints()))) {
  size_ = shared_;
  for (std::size_t j = 0; j < sums.joints(); ++j) {
    const std::vector<Index>& own = model.own[j];
    const auto more = static_cast<Index>(own.size());
    const Index all = sums.sums_[j].front().gram.rows();
    Eigen::MatrixXd T = Eigen::MatrixXd::Zero(all, shared_ + more);
    T.topLeftCorner(sums.links_, shared_) = model.shared;
    if (model.turned.size() > 0) T.leftCols(shared_) *= model.turned(static_cast<Index>(j));
    for (Index k = 0; k < more; ++k)
      T(sums.links_ + own[static_cast<std::size_t>(k)], shared_ + k) = 1.0;
    const auto in_own_columns = [&](const std::vector<ArmSums::Piece>& of_all) {
      std::vector<ArmSums::Piece> pieces;
      for (const auto& piece : of_all) {
        pieces.push_back({T.transpose() * piece.gram * T, T.transpose() * piece.match, piece.square,
                          piece.rows});
      }
      return pieces;
    };
    pieces_.push_back(in_own_columns(sums.sums_[j]));
    left_out_.push_back(in_own_columns(sums.left_out_[j]));
    maps_.push_back(std::move(T));
    first_.push_back(size_);
    size_ += more;
  }
  first_.push_back(size_);
}

std::vector<Index> ArmRegression::places(std::size_t joint) const {
  std::vector<Index> list;
  for (Index k = 0; k < shared_; ++k) list.push_back(k);
  for (Index k = first_[joint]; k < first_[joint + 1]; ++k) list.push_back(k);
  return list;
}

Eigen::VectorXd ArmRegression::fit(Index left_out, std::size_t from, std::size_t to) const {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(size_, size_);
  Eigen::VectorXd match = Eigen::VectorXd::Zero(size_);
  for (std::size_t j = from; j < to; ++j) {
    const std::vector<Index> own = places(j);
    const double variance = variance_(static_cast<Index>(j));
    for (std::size_t p = 0; p < pieces_[j].size(); ++p) {
      if (static_cast<Index>(p) == left_out) continue;
      gram(own, own) += pieces_[j][p].gram / variance;
      match(own) += pieces_[j][p].match / variance;
    }
  }
  gram.diagonal().head(shared_) *= 1.0 + ridge_;
  return solve_gram(gram, match, kSharedBaseRidge);
}

void ArmRegression::shrink() {
  constexpr double kLeast = 1e-8, kMost = 1.0, kStep = 10.0;
  double best = 0.0, least = left_out().sum();
  for (ridge_ = kLeast; ridge_ <= kMost; ridge_ *= kStep) {
    const double error = left_out().sum();
    if (error < least) least = error, best = ridge_;
  }
  ridge_ = best;
}

double ArmRegression::misfit(std::size_t joint, const ArmSums::Piece& piece,
                             const Eigen::VectorXd& x) const {
  const Eigen::VectorXd c = x(places(joint));
  return piece.square - 2.0 * c.dot(piece.match) + c.dot(piece.gram * c);
}

void ArmRegression::reweight() {
  for (int pass = 0; pass < kReweightings; ++pass) {
    const Eigen::VectorXd x = fit(-1, 0, pieces_.size());
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      double sum = 0.0, rows = 0.0;
      for (std::size_t p = 0; p < pieces_[j].size(); ++p) {
        sum += misfit(j, pieces_[j][p], x);
        rows += pieces_[j][p].rows;
      }
      variance_(static_cast<Index>(j)) = std::max(1e-300, sum / std::max(1.0, rows));
    }
  }
}

Eigen::VectorXd ArmRegression::shared(Index left_out, std::optional<std::size_t> joint) const {
  return fit(left_out, joint.value_or(0), joint ? *joint + 1 : pieces_.size()).head(shared_);
}

Eigen::MatrixXd ArmRegression::deviations(std::optional<std::size_t> joint) const {
  const Index pieces = sums_.pieces();
  Eigen::MatrixXd without(shared_, pieces);
  for (Index p = 0; p < pieces; ++p) without.col(p) = shared(p, joint);
  const auto n = static_cast<double>(pieces);
  return std::sqrt((n - 1.0) / n) * (without.colwise() - without.rowwise().mean());
}

Eigen::MatrixXd ArmRegression::left_out() const {
  const auto pieces = static_cast<Index>(pieces_.front().size());
  Eigen::MatrixXd errors(pieces, variance_.size());
  for (Index p = 0; p < pieces; ++p) {
    const Eigen::VectorXd x = fit(p, 0, pieces_.size());
    for (Index j = 0; j < variance_.size(); ++j) {
      const auto joint = static_cast<std::size_t>(j);
      errors(p, j) = misfit(joint, left_out_[joint][static_cast<std::size_t>(p)], x) / variance_(j);
    }
  }
  return errors;
}

void ArmRegression::compare(std::size_t joint, Index piece, const Eigen::VectorXd& x,
                            const ArmRegression& other, const Eigen::VectorXd& others,
                            evidence::BlockChange& change) const {
  // All of a law's error may lie along what the two differ by.
  double inexact = 0.0;
  for (const ArmSums::Piece& each : pieces_[joint]) inexact += each.square;
  const double variance =
      variance_(static_cast<Index>(joint)) + prior::kModelError * prior::kModelError * inexact;
  const Eigen::VectorXd apart = coefficients(joint, x) - other.coefficients(joint, others);
  const auto p = static_cast<std::size_t>(piece);
  const Eigen::MatrixXd& gram = sums_.left_out_[joint][p].gram;
  change.fall += (other.misfit(joint, other.left_out_[joint][p], others) -
                  misfit(joint, left_out_[joint][p], x)) /
                 variance;
  change.apart += apart.dot(gram * apart) / variance;
}

double ArmRegression::log_support_against(const ArmRegression& other) const {
  std::vector<evidence::BlockChange> blocks;
  const auto pieces = static_cast<Index>(pieces_.front().size());
  for (Index p = 0; p < pieces; ++p) {
    const Eigen::VectorXd own = fit(p, 0, pieces_.size()), others = other.fit(p, 0, pieces_.size());
    evidence::BlockChange change;
    double rows = 0.0;
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      compare(j, p, own, other, others, change);
      rows += pieces_[j][static_cast<std::size_t>(p)].rows;
    }
    if (rows > 0.0) blocks.push_back(change);
  }
  return evidence::log_support(blocks);
}

Eigen::MatrixXd ArmRegression::promises() const {
  const Eigen::VectorXd x = fit(-1, 0, pieces_.size());
  const Index links = sums_.links_, own = maps_.front().rows() - links;
  Eigen::MatrixXd list(variance_.size(), own);
  for (std::size_t j = 0; j < pieces_.size(); ++j) {
    const Eigen::VectorXd c = coefficients(j, x);
    Eigen::VectorXd match = Eigen::VectorXd::Zero(own);
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(own, own);
    for (const ArmSums::Piece& piece : sums_.sums_[j]) {
      match += piece.match.tail(own) - piece.gram.bottomRows(own) * c;
      gram += piece.gram.bottomRightCorner(own, own);
    }
    // What the joint's terms in use leave of each column.
    const Eigen::MatrixXd used = maps_[j].bottomRightCorner(own, maps_[j].cols() - shared_);
    const Eigen::MatrixXd shares = used.transpose() * gram;
    const Eigen::MatrixXd taken = solve_gram(shares * used, shares, kSharedBaseRidge);
    for (Index k = 0; k < own; ++k) {
      const double left =
          std::max(gram(k, k) - shares.col(k).dot(taken.col(k)), kSharedBaseRidge * gram(k, k));
      list(static_cast<Index>(j), k) =
          match(k) * match(k) / std::max(1e-300, left * variance_(static_cast<Index>(j)));
    }
  }
  return list;
}

Eigen::VectorXd ArmRegression::resisted() const {
  const Eigen::VectorXd x = fit(-1, 0, pieces_.size());
  Eigen::VectorXd power = Eigen::VectorXd::Zero(variance_.size());
  for (std::size_t j = 0; j < pieces_.size(); ++j) {
    const Eigen::VectorXd c = coefficients(j, x).tail(maps_[j].rows() - sums_.links_);
    for (const ArmSums::Piece& piece : sums_.sums_[j]) {
      const auto rate = piece.gram.row(sums_.links_ + kOwnRate);
      power(static_cast<Index>(j)) += rate.tail(c.size() - 1).dot(c.tail(c.size() - 1));
    }
  }
  return power.cwiseQuotient(variance_);
}

double ArmRegression::log_support_alone(std::size_t joint) const {
  std::vector<evidence::BlockChange> blocks;
  for (Index p = 0; p < sums_.pieces(); ++p) {
    if (pieces_[joint][static_cast<std::size_t>(p)].rows == 0.0) continue;
    evidence::BlockChange change;
    compare(joint, p, fit(p, joint, joint + 1), *this, fit(p, 0, pieces_.size()), change);
    blocks.push_back(change);
  }
  return evidence::log_support(blocks);
}

}  // namespace dcnn
