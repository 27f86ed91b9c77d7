// SPDX-License-Identifier: Apache-2.0
// One regression for all joints of an arm, and what it predicts of pieces of time that were left
// out.
#pragma once

#include <optional>

#include "diagnosis/arm_rows.h"
#include "diagnosis/evidence/support.h"

namespace dcnn {

/// What is fitted to an arm: parameters that all joints share, and terms of each joint.
struct ArmModel {
  Eigen::MatrixXd shared;               ///< (10·joints, p): links' parameters from the shared ones
  std::vector<std::vector<Index>> own;  ///< columns of JointRows::own in use, by joint
  /// 1, or -1 where a joint measures what the rows take for the other's reaction.
  Eigen::VectorXd turned = {};
};

/// Sums of products of all columns and the target over each piece of time.
///
/// A piece that is left out knows the offset and friction of a joint from the others only as well
/// as they tell them: not at all where the joint stood still there. Its squared errors are in the
/// metric of that prediction, (I + F G⁻¹ F')⁻¹ = I - F (F'F + G)⁻¹ F', with F its columns of offset
/// and friction and G their information in all other pieces.
class ArmSums {
 public:
  explicit ArmSums(const std::vector<JointRows>& joints);
  Index pieces() const { return pieces_; }
  std::size_t joints() const { return sums_.size(); }

 private:
  friend class ArmRegression;
  struct Piece {
    Eigen::MatrixXd gram;
    Eigen::VectorXd match;
    double square = 0.0, rows = 0.0;
  };
  static Piece as_left_out(const Piece& piece, Index first, const Eigen::MatrixXd& friction);
  std::vector<std::vector<Piece>> sums_;      // by joint and piece
  std::vector<std::vector<Piece>> left_out_;  // the same in the metric of a piece left out
  Index pieces_ = 0, links_ = 0;              // links_: columns of the arm
};

/// Least squares of one model over all joints, each weighted by what it leaves.
class ArmRegression {
 public:
  ArmRegression(const ArmSums& sums, ArmModel model);

  /// Weights of the joints by what each leaves; or those of another regression.
  void reweight();
  void set_variances(const Eigen::VectorXd& variances) { variance_ = variances; }
  const Eigen::VectorXd& variances() const { return variance_; }
  /// Shrinks the shared parameters towards zero by the ridge with which pieces that were left out
  /// are predicted best: what a motion hardly tells is not extrapolated to another. (The largest
  /// ridge within a standard error of that gives up what is told: 1.6 for 0.6 N·m on a hand-guided
  /// arm.)
  void shrink();

  /// The shared parameters fitted to all pieces but one (-1: to all), of all joints or as one joint
  /// by itself has them.
  Eigen::VectorXd shared(Index left_out, std::optional<std::size_t> joint = {}) const;
  /// (p, pieces): how far those parameters may be off: deviations of their estimates without each
  /// piece, whose outer products sum to their covariance (the jackknife of blocks, Kunsch
  /// 1989), which knows of errors that last and of laws that were left out.
  Eigen::MatrixXd deviations(std::optional<std::size_t> joint = {}) const;
  /// (pieces, joints): squared error, in units of the joints' variances, on pieces that were left
  /// out.
  Eigen::MatrixXd left_out() const;
  /// ln of the factor by which pieces that were left out change the odds of this model against
  /// another of the same sums and variances (diagnosis/evidence/support.h), each piece a
  /// block.
  double log_support_against(const ArmRegression& other) const;
  /// (joints, columns of JointRows::own): by how much each column by itself would lower the squared
  /// error of its joint, in units of its variance.
  Eigen::MatrixXd promises() const;
  /// (joints): the power that the joints' own terms take by the rate in JointRows::own, summed over
  /// rows, in units of their variances.
  Eigen::VectorXd resisted() const;
  /// The same for one joint with a set of shared parameters of its own, against the set of all.
  double log_support_alone(std::size_t joint) const;

 private:
  Eigen::VectorXd fit(Index left_out, std::size_t from, std::size_t to) const;
  std::vector<Index> places(std::size_t joint) const;
  double misfit(std::size_t joint, const ArmSums::Piece& piece, const Eigen::VectorXd& x) const;
  /// Adds what a joint's rows of a piece say for these unknowns against those of another.
  void compare(std::size_t joint, Index piece, const Eigen::VectorXd& x, const ArmRegression& other,
               const Eigen::VectorXd& others, evidence::BlockChange& change) const;
  /// Coefficients of all columns of a joint, fitted without a piece.
  Eigen::VectorXd coefficients(std::size_t joint, const Eigen::VectorXd& x) const {
    return maps_[joint] * x(places(joint));
  }

  const ArmSums& sums_;
  std::vector<Eigen::MatrixXd> maps_;  // from the model's columns to all, by joint
  std::vector<std::vector<ArmSums::Piece>> pieces_, left_out_;  // in the model's own columns
  std::vector<Index> first_;  // unknowns of each joint begin there
  Index shared_ = 0, size_ = 0;
  Eigen::VectorXd variance_;
  double ridge_ = 0.0;  // of each shared parameter's information
};

}  // namespace dcnn
