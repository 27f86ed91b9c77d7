// SPDX-License-Identifier: Apache-2.0
// Line fits of several windows mixed into one estimate of each channel, by how noisy it is now.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/models/model.h"

namespace dcnn {

/// How noisy the channels are now: 0.5 log10 of the running mean square of their second
/// differences, mean over the channels in units of their spread. It tells the level of noise that
/// short and long windows have to be chosen by, without being told it.
class NoiseLevel {
 public:
  /// `scale` (channels) is what a channel is divided by; it is the first ones of a row.
  explicit NoiseLevel(Eigen::VectorXd scale);
  void restart() { count_ = 0; }
  /// The next row of a segment; the level after it. Allocates nothing.
  double push(const Eigen::RowVectorXd& row) noexcept;
  /// What push() gives while too few rows are known: more than any level.
  static constexpr double kUnknown = 1e9;

 private:
  static constexpr Index kSpan = 128, kFewest = 8;
  Eigen::VectorXd scale_, before_, second_before_, square_;
  Index count_ = 0;
};

/// At each of some levels of noise the weights of the lines that come nearest to the clean channel
/// over the training rows (least squares, channel by channel); between the levels, in between. A
/// mean of a channel given what was seen keeps the slope that the force has on the clean channel,
/// so that one linear part can serve every level.
class LineMixture {
 public:
  LineMixture() = default;
  /// `lengths` in samples; `channels` of a row, from the first on, tell the level.
  static LineMixture learn(const Samples& training, const NoiseSpec& noise, const InputMap& map,
                           const std::vector<Index>& lengths, Index channels);

  /// (F) for lines (windows, F) at a level; allocates nothing.
  void mix(const Eigen::MatrixXd& lines, double level, Eigen::RowVectorXd& mixed) const noexcept;
  /// (N, F) for lines (N, F) of every window.
  Eigen::MatrixXd of(const Eigen::MatrixXd& x, const std::vector<Index>& segment_begin,
                     const std::vector<Eigen::MatrixXd>& lines) const;
  NoiseLevel noise_level() const { return NoiseLevel(scale_); }

  Json to_json() const;
  /// For that number of features and windows; Error(kModel).
  static LineMixture parse(const Json& json, Index features, Index windows,
                           const std::string& where);

 private:
  Eigen::VectorXd scale_, mean_;  // (channels), (F)
  Eigen::VectorXd levels_;        // (L) rising
  Eigen::MatrixXd weights_;       // (L, windows F), window by window of a channel
};

}  // namespace dcnn
