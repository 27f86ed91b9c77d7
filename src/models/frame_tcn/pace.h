// SPDX-License-Identifier: Apache-2.0
// Whether a motion is, for seconds on end, faster than the filters were made for.
#pragma once

#include <Eigen/Dense>

#include "models/frame_tcn/blocks.h"

namespace dcnn::frame_tcn {

/// The denoised accelerations of the last four seconds (at 500 Hz) beside the strongest ones of the
/// training at the same level of noise. A second varies as much within one motion as between it and
/// its double; four seconds of a motion of many tones hardly vary.
class Pace {
 public:
  static constexpr Index kSpan = 2048, kStride = 16;  ///< rows; every so manyth is looked at
  static constexpr Index kSigns = 4;
  Pace() = default;
  explicit Pace(Index levels);

  /// Of denoised rows that are kStride apart (15, n): strength of a and of theta'', and of each in
  /// proportion to the rate it is of, (4, n), all log10.
  static Eigen::MatrixXd signs(const Eigen::MatrixXd& clean);
  /// Level of noise of the same rows (15, n), mean over the same time.
  static Eigen::MatrixXd mean_levels(const Eigen::MatrixXd& levels);

  /// At level k of noise: what one column of `signs` in a thousand exceeds, with a margin.
  void learn(Index k, const Eigen::MatrixXd& signs, const Eigen::MatrixXd& mean_levels);
  /// (n) how many times the limit of the nearest level the strongest sign is.
  Eigen::VectorXd score(const Eigen::MatrixXd& clean, const Eigen::MatrixXd& levels) const;
  Index levels() const { return limit.cols(); }

  Eigen::MatrixXd level;  ///< (15, levels) standardised, as the gates see it
  Eigen::MatrixXd limit;  ///< (4, levels) of the signs
};

}  // namespace dcnn::frame_tcn
