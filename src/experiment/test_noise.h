// SPDX-License-Identifier: Apache-2.0
// Noise on what a model is evaluated on.
#pragma once

#include <string>
#include <vector>

#include "dcnn/experiment/evaluate.h"

namespace dcnn {

/// Rows of all recordings under one another, as one model sees them.
struct TestSet {
  Stream stream;
  Eigen::MatrixXd wanted, unfiltered, base;  // base: the part a simulator predicts
  Index singular = 0, first_rows = 0;        // first_rows: those of the first recording
  Eigen::VectorXd first_t;
};

/// Puts more rows under those that are there.
void stack(Eigen::MatrixXd& under, const Eigen::MatrixXd& more);
/// Every k-th row, from the first on.
Eigen::MatrixXd every_kth(const Eigen::MatrixXd& rows, Index k);

/// Where the noise acts, and what its level is measured by, in words.
std::string describe(const EvaluationRequest& request);

/// The features with the noise of a level; as they are where that is empty.
Eigen::MatrixXd noisy_features(const EvaluationRequest& request, const TestSet& set,
                               const Identifier& identifier,
                               const std::vector<Recording>& recordings, const SnrLevel& level,
                               int run);

/// What the simulator predicts from the pose with the same noise, of the rows that are scored;
/// noise on features does not reach it.
Eigen::MatrixXd noisy_base(const EvaluationRequest& request, const TestSet& set,
                           const Identifier& identifier, const std::vector<Recording>& recordings,
                           const SnrLevel& level, int run);

/// Of the rows to be scored, with noise on the entries of X*; empty where the model has none.
Eigen::MatrixXd predict_noisy_entries(const EvaluationRequest& request, const Model& model,
                                      const Stream& stream, const SnrLevel& level, int run);

}  // namespace dcnn
