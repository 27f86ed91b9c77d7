// SPDX-License-Identifier: Apache-2.0
// The numbers of sketches fitted to the residual, and what that gains.
#pragma once

#include "discovery/data.h"

namespace dcnn::discovery {

struct Trial {
  Sketch sketch;
  double gain = 0.0;       ///< of chi-square
  double score = 0.0;      ///< of it, less the complexity penalty
  Eigen::VectorXd column;  ///< whitened, beside what is known, of unit amplitude
};

/// The gain of a sketch with the numbers that it has, its amplitude solved for.
Trial weighed(const Data& data, const Sketch& sketch);

/// Gauss-Newton over its numbers, the amplitude solved for, at most so many steps.
Trial refined(const Data& data, const Sketch& sketch, int most_steps);
/// The same of sketches whose forces add up, all numbers together; the amplitudes alone for no
/// steps.
std::vector<Sketch> refined_together(const Data& data, const std::vector<Sketch>& terms,
                                     int most_steps);

/// Derivatives of the whitened column by the numbers that are fitted, the amplitude first, in the
/// order of the law's numbers; by the numbers themselves, not their search scales.
Eigen::MatrixXd tangent_of(const Data& data, const Sketch& sketch);

/// A curve where the motion hardly is goes on as beside: its second differences weigh a little of
/// what the mean value of its nodes does. In the normal equations of a sketch's numbers, whose
/// first row is the amplitude's and whose others are those of handles_of().
void add_bending(const Data& data, Sketch sketch, Eigen::MatrixXd& gram, Eigen::VectorXd& score);

/// The penalty of a sketch: by its numbers, factors and memories; `largest` is the largest gain of
/// any sketch, of which a share per number is what an error of the motion could buy.
double penalty(const Sketch& sketch, double largest);

/// Scores by the largest gain of all; the best first.
void rank(std::vector<Trial>& trials);

}  // namespace dcnn::discovery
