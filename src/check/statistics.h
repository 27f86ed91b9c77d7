// SPDX-License-Identifier: Apache-2.0
// Small robust statistics of one channel.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "check/priors.h"

namespace dcnn::check {

double median(const Eigen::VectorXd& values);  ///< 0 for none
double rms_of(const Eigen::VectorXd& values);  ///< 0 for none
/// Not one value throughout, of which the mean differs by rounding.
bool varies(const Eigen::VectorXd& values);
/// Standard deviation of normal values by their median absolute deviation.
double robust_deviation(const Eigen::VectorXd& values);
/// Of white noise, from second differences, in which a slow signal cancels.
double noise_of(const Eigen::VectorXd& values);
/// Share of the steps that are exactly zero.
double repeats(const Eigen::VectorXd& values);
/// Rows of equal value one after the other.
struct Run {
  Eigen::Index begin = 0, length = 0;
  double value = 0.0;
};
std::vector<Run> runs_of(const Eigen::VectorXd& values);
/// (n-1) steps.
Eigen::VectorXd steps_of(const Eigen::VectorXd& values);

/// Median of chi square with so many degrees of freedom, 1 or 3.
double chi_square_median(Eigen::Index freedom);

/// Log density of a log-normal quantity relative to its largest, not below -kMostSurprise.
double plausibility(double value, const Typical& typical);
/// 1/(1 + exp(-x)): 0 and 1 at minus and plus infinity, and nowhere a quotient of infinities.
double probability_of_log_odds(double x);
/// ln p/(1-p)
double log_odds_of(double p);
/// ln of a sum of exponentials, of one term at least.
double log_sum(const Eigen::VectorXd& terms);
/// exp(x_k) over the sum of all.
Eigen::VectorXd shares_of(const Eigen::VectorXd& log_weights);
/// Probability of a fault whose prior is kFaultPrior where a statistic's p-value is `p`: the bound
/// of Sellke, Bayarri and Berger (2001) on the Bayes factor, -e p log p.
double posterior_of_p(double p);

}  // namespace dcnn::check
