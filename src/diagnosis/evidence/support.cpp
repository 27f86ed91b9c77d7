// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/support.h"

#include <algorithm>

namespace dcnn::evidence {

namespace {

BlockChange sum_of(const std::vector<BlockChange>& blocks) {
  BlockChange all;
  for (const BlockChange& block : blocks) all.fall += block.fall, all.apart += block.apart;
  return all;
}

/// One over the factor by which the fall varies more than in white noise, at most 1; 0 where blocks
/// say nothing.
double weight_of(const std::vector<BlockChange>& blocks, const BlockChange& all) {
  if (blocks.size() < 2 || all.apart <= 0.0) return 0.0;
  double square = 0.0;  // of each block's fall about what its share of `apart` would make of it
  for (const BlockChange& block : blocks) {
    const double off = block.fall - block.apart * all.fall / all.apart;
    square += off * off;
  }
  const auto n = static_cast<double>(blocks.size());
  const double variance = square * n / (n - 1.0);
  return 1.0 / std::max(1.0, variance / (4.0 * all.apart));
}

}  // namespace

double log_support(const std::vector<BlockChange>& blocks) {
  const BlockChange all = sum_of(blocks);
  return 0.5 * all.fall * weight_of(blocks, all);
}

double log_support(const std::vector<BlockChange>& blocks, double gained) {
  const BlockChange all = sum_of(blocks);
  const double weight = weight_of(blocks, all);
  if (weight == 0.0) return 0.0;
  // Largest over s of s r d - (s d)^2/2 - gained (s - 1)^2/2, with d the length of what the two
  // predict apart and r what was measured along it: fall = 2 r d - d^2.
  const double beyond = (all.fall - all.apart) * (all.fall - all.apart) / (4.0 * all.apart);
  const double known = std::max(0.0, gained);
  const double moved = beyond * all.apart / (all.apart + known);
  return 0.5 * (all.fall + moved) * weight;
}

void MeanSquares::add(double error_with, double error_without, double deviation) {
  const double a = error_with / deviation, b = error_without / deviation;
  with += a * a;
  without += b * b;
  apart += (a - b) * (a - b);
}

double share_explained(const std::vector<MeanSquares>& channels, double blocks) {
  double sum = 0.0, weights = 0.0;
  for (const MeanSquares& channel : channels) {
    const double gain = std::max(0.0, channel.without - channel.with),
                 rest = std::max(0.0, channel.with - blocks);
    weights += channel.apart;
    sum += channel.apart * (rest > 0.0 ? gain / (gain + rest) : 1.0);
  }
  return weights < 1.0 ? 1.0 : sum / weights;
}

}  // namespace dcnn::evidence
