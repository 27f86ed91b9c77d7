// SPDX-License-Identifier: Apache-2.0
// A law for what no effect of the catalogue explains: structure, numbers, and what they gain.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/physics/law.h"

namespace dcnn::discovery {

/// One recording: its motion, and the force to which a law is added.
struct Record {
  const Motion* motion = nullptr;
  Eigen::MatrixXd load;  ///< (T,3) N, in S
};

/// What a whitened number belongs to.
struct Row {
  std::size_t record = 0, channel = 0;
  double t = 0.0;  ///< s
};

/// A residual and what would have to explain it.
struct Problem {
  std::vector<Record> records;
  /// Forces (T,3) in S, one per record, to independent numbers of unit variance; linear.
  std::function<Eigen::VectorXd(const std::vector<Eigen::MatrixXd>&)> whiten;
  /// Its transpose; may be approximate: it only chooses what is looked at.
  std::function<std::vector<Eigen::MatrixXd>(const Eigen::VectorXd&)> transposed;
  std::vector<Row> rows;
  Eigen::VectorXd residual;  ///< whitened, 0 in rows that must not be looked at
  Eigen::MatrixXd known;     ///< whitened columns that are fitted beside the law, orthonormal
  /// Whether a search should end with what it has; null: never.
  std::function<bool()> is_spent = nullptr;
};

/// A law and what speaks for it.
struct Discovered {
  law::Law law;
  Eigen::VectorXd deviation;   ///< of its numbers, 0 where they are references
  double gain = 0.0;           ///< of chi-square
  double inflation = 1.0;      ///< of the variance of its score by coloured residuals, at least 1
  double score = 0.0;          ///< gain over the inflation, less the complexity penalty
  double held_out_gain = 0.0;  ///< of chi-square, over folds that its numbers were not fitted to
  double disagreement = 0.0;   ///< variance of its strength over blocks of time; 1 if constant
  bool established = false;    ///< the form holds in all blocks; else it is an approximation
  std::vector<std::string> rivals;  ///< expressions of forms within the margin
};

/// The laws that the residual holds, the greatest gain first; none where nothing is established.
/// Deterministic.
std::vector<Discovered> discover(const Problem& problem);

/// The numbers of laws fitted again to a problem of another rate, without those that are not
/// accepted there.
std::vector<Discovered> refitted(const Problem& problem, const std::vector<Discovered>& laws);

}  // namespace dcnn::discovery
