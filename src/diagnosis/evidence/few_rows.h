// SPDX-License-Identifier: Apache-2.0
// Poses at rest tell their noise by what is left of them alone: its variance, in units of the
// floors, is integrated over, so that residuals have Student's distribution and not a normal one.
#pragma once

#include "diagnosis/evidence/marginal.h"

namespace dcnn::evidence {

/// ln of the integral of s^(-n) exp(-S/(2 s²)) over the noise's variance s²: S the sum of squares,
/// n the rows less the numbers that they decide. The prior of s² is a scaled inverse chi-square
/// with one degree of freedom: what one row at the floor would tell.
double log_student(double square, double freedom);

/// log_evidence() - y'y/2 with the noise's variance integrated over. Of numbers with a prior those
/// count as decided that the rows tell better than it: trace of (X'X + P)^-1 X'X.
double log_student_evidence(const Linear& model, double rows);

/// log_field() with the noise's variance integrated over: `square` and `freedom` are those of what
/// the model leaves.
double log_student_field(const Eigen::MatrixXd& gram, const Eigen::VectorXd& match, double square,
                         double freedom, double least, double most, double* tau);

/// Rows less the numbers that a model's rows decide.
double freedom_of(const Linear& model, double rows);

}  // namespace dcnn::evidence
