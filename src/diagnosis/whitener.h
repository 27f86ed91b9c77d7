// SPDX-License-Identifier: Apache-2.0
// From signals at the log's rate to independent numbers of unit variance.
#pragma once

#include "diagnosis/noise_floor.h"

namespace dcnn {

/// Means over blocks of about 20 ms, whitened by an AR(8) filter of the floor's spectrum. The same
/// linear map for measurements and columns. Nothing crosses a gap; the ends of every segment, where
/// the smoother has one side only, are left out. Where the channels' noise is correlated, each row
/// is what the channels before it do not tell of it (the inverse of Cholesky's factor).
class Whitener {
 public:
  /// `correlation` of the channels' noise; empty: none.
  Whitener(const Case& study, const std::vector<Floor>& floors, const Signals& levels,
           const Eigen::MatrixXd& correlation = {});

  /// Weighs rows by noise and error of the laws: level^2 -> (level^2 + m)/(1 + m), m the mean
  /// square of what is `left` in units of the noise's, less its own 1. The noise of a machine at
  /// rest may be a hundredth of that in motion, and its friction there is any up to the one that
  /// breaks loose: by their noise alone such rows would outweigh all others. Rows whose `mask` is 0
  /// say nothing.
  void allow_for_error(const Signals& left, const Eigen::VectorXd& mask);

  /// The same map for signals seen at every stride-th sample (thinned()).
  Whitener at_stride(Index stride) const;
  /// A stride at which a block still holds two samples.
  Index coarse_stride() const { return block_ % 2 == 0 ? block_ / 2 : 1; }

  Index block() const { return block_; }  ///< samples of a mean
  Index rows() const { return rows_; }
  Eigen::VectorXd operator()(const Signals& signals) const;
  /// The transpose of that map; recordings have these numbers of samples.
  Signals transposed(const Eigen::VectorXd& rows, const std::vector<Index>& sizes) const;

  /// What one number of the result belongs to.
  struct Row {
    std::uint32_t log, channel;
    double t;  ///< s, middle of the block
  };
  const std::vector<Row>& row_info() const { return info_; }
  double block_seconds() const { return block_seconds_; }
  /// Density of a channel's whitened noise at `hz`: 1 where its filter remembers long enough, more
  /// at the lowest frequencies of slow noise.
  double expected_density(Index channel, double hz) const;
  /// Logarithm of the determinant of the noise's covariance: with the sum of squares, minus twice
  /// the log-likelihood, by which floors are compared.
  double log_determinant() const;
  /// Standard deviation of a block's noise by channel, in the target's unit.
  const Eigen::VectorXd& block_deviation() const { return block_deviation_; }

 private:
  struct Run {  // the blocks of one segment
    std::size_t log;
    Index first, count;         // first sample, number of blocks
    Index margin;               // samples left out at its beginning
    std::vector<Index> before;  // sizes of the recording's segments before this one
    /// `first` in a recording of which every stride-th sample is seen.
    Index thin_begin(Index stride) const;
  };
  /// Predictors of orders 0 … 8 (48 for slow noise) and their innovation deviations.
  struct Filter {
    std::vector<std::vector<double>> coefficients;
    std::vector<double> deviation;
  };

  std::vector<Run> runs_;
  std::vector<Filter> filters_;  // per channel
  std::vector<Floor> floors_;
  std::vector<Row> info_;
  Eigen::VectorXd inverse_level_;  // per row
  Eigen::MatrixXd decorrelate_;    // (channels, channels), lower triangular; empty: none
  Eigen::VectorXd block_deviation_;
  Index block_ = 1, rows_ = 0, channels_ = 0;
  double block_seconds_ = 0.0;
};

/// The rows of forces, which come before those of torques.
std::vector<Index> rows_of_forces(const Case& study, const Whitener& whitener);

}  // namespace dcnn
