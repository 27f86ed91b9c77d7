// SPDX-License-Identifier: Apache-2.0
// Marginal likelihoods of linear Gaussian models, from Gram matrices.
#pragma once

#include "diagnosis/joint_fit.h"

namespace dcnn::evidence {

/// y = X x + noise of unit variance, x_k ~ N(0, 1/precision_k); precision 0 is a flat prior.
struct Linear {
  Eigen::MatrixXd gram;   ///< X'X
  Eigen::VectorXd match;  ///< X'y
  double square = 0.0;    ///< y'y
  Eigen::VectorXd precision;
};
Linear linear_model(const Eigen::MatrixXd& X, const Eigen::VectorXd& y,
                    const Eigen::VectorXd& precision);

/// Least of |y - Xx|² + sum precision_k x_k².
double least_square(const Linear& model);
/// Logarithm of the determinant of X'X + diag(precision), columns that others hold left out.
double log_determinant(const Linear& model);
/// ln of integral p(y|x) p(x) dx over p(y|0), up to the volume of flat priors: 0.5 (y'y - least -
/// ln|X'X + P| + ln|P| over proper priors + flat·ln 2 pi).
double log_evidence(const Linear& model);

/// ln of the Bayes factor of a field y = Phi f, f ~ N(0, tau² I), with tau log-uniform between
/// `least` and `most`, beside a linear model that is already there: `gram` and `match` are Phi'Phi
/// and Phi'y with that model projected out. The likeliest tau in `tau`.
double log_field(const Eigen::MatrixXd& gram, const Eigen::VectorXd& match, double least,
                 double most, double* tau = nullptr);

/// ln sum exp.
double log_sum(const std::vector<double>& logarithms);

}  // namespace dcnn::evidence
