// SPDX-License-Identifier: Apache-2.0
// Eq. 7: every feature x becomes one row [x, x - mean, (x - mean)/sd, |x|, x^2].
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/core/options.h"
#include "dcnn/core/parallel.h"

namespace dcnn {

class InputMap {
 public:
  static constexpr Index kColumns = 5;
  struct Spec {
    bool variance =
        false;  ///< divide by the variance, as the paper says, not the standard deviation
    bool zerocenter = true;  ///< subtract the per-cell mean over the training part
    /// Least deviation to divide by, as a share of the largest among features of the same unit: a
    /// component that hardly moved beside its sisters holds noise, and its z-score would explode on
    /// the first recording in which it does move. 0 is the paper.
    double sigma_floor = 0.0;
    double clip = 0.0;  ///< features are held within mean ± clip·deviation; 0 is not at all
  };

  InputMap() = default;
  /// Statistics of the training features (T, F), N - 1 in the denominator; sd below 1e-12 counts
  /// as 1. `units` (F) says which features are of one kind; an empty unit stands alone.
  InputMap(const Eigen::MatrixXd& training, Spec spec, const std::vector<std::string>& units = {});

  Index features() const { return mean_.size(); }
  const Eigen::VectorXd& mean() const { return mean_; }
  const Eigen::VectorXd& deviation() const { return deviation_; }  ///< standard deviation
  /// Mean square of each training feature (noise.power meansquare).
  const Eigen::VectorXd& mean_square() const { return mean_square_; }

  /// Writes the (F, 5) map of one feature vector, row-major, zero-centred where asked for.
  /// `Out` is float or double.
  template <class Out>
  void write(const double* x, Out* map) const;

  Json to_json() const;
  static InputMap parse(const Json& json, const std::string& where, Exit exit);

 private:
  void derive();

  Eigen::VectorXd mean_, deviation_, mean_square_;
  Eigen::VectorXd scale_;  // the deviation, floored
  Eigen::VectorXd inverse_scale_, least_, most_;
  Eigen::VectorXd centre_;  // (F·5), zeros without zerocenter
  Spec spec_;
};

/// Keys: sigma (std|variance), zerocenter, sigma_floor, clip.
InputMap::Spec parse_input_map(Options options);

}  // namespace dcnn
