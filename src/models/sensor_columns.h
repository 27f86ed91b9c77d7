// SPDX-License-Identifier: Apache-2.0
// Five columns of every channel in the sensor frame: what DCNN+ and DCNN-T see instead of Eq. 7.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dcnn/data/sensor_frame.h"
#include "dcnn/models/network_input.h"
#include "models/line_mixture.h"

namespace dcnn {

/// (F, columns, 1), every entry standardised by the clean training rows and clipped at ±5:
///   body   x, x - mean, (x - mean)/sd, tanh(x/(0.08 sd)), x^2 of the row itself
///   lines  causal line fits over several windows (line_filter.h), their mixture by the level of
///          noise (line_mixture.h), and tanh of that; without `adaptive` no mixture, and tanh of
///          the third line
/// with x a channel in the sensor frame. Lines are fitted to the features before the turn: products
/// of noisy angles and rates have a bias that no later filter removes. The tanh saturates as dry
/// friction does. Its sd counts as at least 0.3: a channel that hardly changes sign would otherwise
/// make an entry that is nearly constant in training and explodes with noise.
class SensorColumns : public NetworkInput {
 public:
  /// Key `windows_s` of kind lines: 3 to 12 window lengths in s, by default those of 8, 24, 64, 128
  /// and 256 samples at 500 Hz; `adaptive` (true).
  SensorColumns(const std::string& kind, Options& options, const FeatureLayout& layout);
  /// From to_json().
  SensorColumns(const std::string& kind, Options& options, Index features,
                const std::string& where);

  Shape shape() const override { return {features_, columns(), 1}; }
  void learn(const Samples& training, const InputMap& map, const NoiseSpec& noise) override;
  PreparedStream prepare(const Stream& stream, const InputMap& map) const override;
  void write(const PreparedStream& stream, const InputMap& map, Index row,
             Real* out) const override;
  std::unique_ptr<StreamingInput> streaming(const InputMap& map) const override;
  Json to_json() const override;

 private:
  class Streaming;
  static constexpr double kClip = 5.0;
  static constexpr double kKnee = 0.08;
  static constexpr std::size_t kSaturatedLine = 2;

  bool is_lines() const { return !lengths_.empty(); }
  Index columns() const {
    return is_lines() ? static_cast<Index>(lengths_.size()) + (adaptive_ ? 2 : 1) : 5;
  }
  /// The column of tanh: the last one of lines, the last but one of body.
  Index saturated_column() const { return is_lines() ? columns() - 1 : 3; }
  /// Columns before standardisation, (N, columns F), channel by channel.
  PreparedStream raw(const Stream& stream) const;

  Index features_;
  SensorFrame frame_;
  std::vector<Index> lengths_;  // of the lines, samples; empty for body
  bool adaptive_ = false;       // lines have their mixture
  Index level_channels_ = 1;    // whose roughness tells the level
  LineMixture mixture_;
  Eigen::VectorXd channel_mean_, knee_;  // (F); the knee of tanh is 0.08 sd
  Eigen::RowVectorXd mean_, deviation_;  // (columns F)
};

}  // namespace dcnn
