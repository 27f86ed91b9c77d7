// SPDX-License-Identifier: Apache-2.0
// How far apart structures are on a motion, once the rival's numbers have been fitted to the
// other's forces.
#pragma once

#include "dcnn/physics/motion.h"
#include "design/question.h"

namespace dcnn::design {

/// One structure on one motion, in deviations of the noise: what it predicts, and its derivatives
/// by its numbers.
struct Prediction {
  Eigen::VectorXd force;    ///< samples of all channels, one channel after the other
  Eigen::MatrixXd tangent;  ///< (rows, numbers), of unit length each
};

/// Predictions of the hypotheses of a question on motions of one rate. Positive numbers that a law
/// refuses below zero are fitted on a logarithmic scale.
class Predictor {
 public:
  Predictor(const Question& question, double rate_hz);

  /// Of hypothesis `k`. Error(kData) where it needs what the motion does not have.
  Prediction predict(std::size_t k, const Motion& motion) const;
  /// Least |target - prediction|² over the numbers of hypothesis k, from its own on (Levenberg and
  /// Marquardt).
  double fitted_square(std::size_t k, const Motion& motion, const Eigen::VectorXd& target) const;

 private:
  struct Number {
    std::size_t effect;
    std::string name;
    bool logarithmic;
  };
  using Effects = std::vector<EffectSpec>;
  Eigen::VectorXd force_of(const Effects& effects, const Motion& motion) const;
  /// The number moved by `by` on its scale.
  static void move(const Number& number, double by, Effects& effects);
  double step_of(const Number& number, const Effects& effects) const;
  Prediction around(std::size_t k, const Effects& effects, const Motion& motion) const;

  const Question& question_;
  double weight_;  // of a sample: the root of log samples per sample
  std::vector<std::vector<Number>> numbers_;
};

/// |D|² - |P D|², D = a.force - b.force and P the projection on b's tangent: the separation of a
/// from the refitted b, to first order in b's numbers.
double separation(const Prediction& a, const Prediction& b);
/// Dimension that two tangent spaces share: trace of the product of their projections.
double shared_dimension(const Prediction& a, const Prediction& b);
/// Columns that span the tangent.
Eigen::Index dimension(const Prediction& a);

}  // namespace dcnn::design
