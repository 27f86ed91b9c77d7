// SPDX-License-Identifier: Apache-2.0
// What data that decided nothing say of two fitted models.
#pragma once

#include <vector>

namespace dcnn::evidence {

/// Of a block of data, in units of the noise: what chi-square falls by from the one model to the
/// other, and the square of what the two predict apart.
struct BlockChange {
  double fall = 0.0, apart = 0.0;
};

/// ln of the likelihood ratio of the two models: half of what chi-square falls by in all, where the
/// noise is white and of the stated size, which makes the fall's variance four times `apart`. Where
/// it varies more over the blocks (coloured noise, an error that both models share), by as much
/// less, and less still where the blocks are few (Student's t). 0 for fewer than two blocks, and
/// where both predict the same.
double log_support(const std::vector<BlockChange>& blocks);

/// The same where the size of what the two predict apart is an estimate: fitted to other rows, in
/// which it gained `gained` of chi-square, so that its variance is 1/gained of its square. Of the
/// first model that size counts which both the fit and these data bear out best: an estimate that
/// hardly differs from zero says little where it is extrapolated. Never below the plain one.
double log_support(const std::vector<BlockChange>& blocks, double gained);

/// Of one channel, in units of the noise, summed over blocks: squares of the errors of a model with
/// a name and without it, and of what the two predict apart.
struct MeanSquares {
  double with = 0.0, without = 0.0, apart = 0.0;
  void add(double error_with, double error_without, double deviation);
};

/// Of what a model without a name leaves beyond noise, the share that the name explains: G/(G + E)
/// in each channel, with G what the square of the error falls by and E what is left of it beyond
/// noise, weighted by how far the two predict apart. 1 where that is less than the noise of one
/// block.
double share_explained(const std::vector<MeanSquares>& channels, double blocks);

}  // namespace dcnn::evidence
