// SPDX-License-Identifier: Apache-2.0
// The recordings at the rate of their block means: what the evidence is computed from.
#pragma once

#include "diagnosis/joint_fit.h"

namespace dcnn::evidence {

/// Whitened block means (Whitener, some 20 ms), averaged further over three: independent, of unit
/// variance, up to 8 Hz for a motion of 20 Hz; laws and fields are told apart below that.
class Grid {
 public:
  explicit Grid(const Setting& setting);

  const Case& study() const { return study_; }  ///< one sample a block
  Index rows() const { return rows_; }
  /// Rows of one channel that follow each other in time.
  struct Run {
    std::uint32_t log, channel;
    Index first, count;
  };
  const std::vector<Run>& runs() const { return runs_; }
  double seconds() const { return seconds_; }  ///< from row to row of a run
  /// The same linear map for vectors that the setting's whitener has whitened …
  Eigen::VectorXd pooled(const Eigen::VectorXd& whitened) const;
  Eigen::MatrixXd pooled(const Eigen::MatrixXd& whitened) const;
  /// … and for signals at one sample a block.
  Eigen::VectorXd operator()(const Signals& signals) const;

 private:
  Whitener whitener_;
  Case study_;
  Eigen::VectorXd mask_;
  std::size_t pool_;  // whitened rows that become one
  std::vector<Index> pool_of_;  // of each whitened row; -1 for none
  std::vector<Run> runs_;
  Index rows_ = 0;
  double seconds_ = 0.0;
};

}  // namespace dcnn::evidence
