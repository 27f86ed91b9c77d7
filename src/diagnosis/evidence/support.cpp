// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/support.h"

#include <algorithm>

#include "core/elementary.h"

namespace dcnn::evidence {

namespace {

BlockChange sum_of(const std::vector<BlockChange>& blocks) {
  BlockChange all;
  for (const BlockChange& block : blocks) all.fall += block.fall, all.apart += block.apart;
  return all;
}

/// Of what chi-square falls by, `fall`, where the two predict `apart`: normal about +-apart, of a
/// variance of four times that in white noise of the stated size. Blocks that vary more add to it,
/// of as many degrees of freedom as there are differences of blocks (Welch, Satterthwaite):
/// Student's t. 0 where blocks say nothing.
double log_ratio(double fall, double apart, const std::vector<BlockChange>& blocks) {
  const BlockChange all = sum_of(blocks);
  if (blocks.size() < 2 || all.apart <= 0.0) return 0.0;
  double square = 0.0;  // of each block's fall about what its share of `apart` would make of it
  for (const BlockChange& block : blocks) {
    const double off = block.fall - block.apart * all.fall / all.apart;
    square += off * off;
  }
  const auto n = static_cast<double>(blocks.size());
  const double white = 4.0 * apart, variance = std::max(white, square * n / (n - 1.0));
  const double estimated = 1.0 - white / variance;  // share of the variance
  if (estimated <= 0.0) return 0.5 * fall;
  const double freedom = (n - 1.0) / (estimated * estimated);
  const auto tail = [&](double off) { return elementary::log1p(off * off / (freedom * variance)); };
  return 0.5 * (freedom + 1.0) * (tail(fall + apart) - tail(fall - apart));
}

}  // namespace

double log_support(const std::vector<BlockChange>& blocks) {
  const BlockChange all = sum_of(blocks);
  return log_ratio(all.fall, all.apart, blocks);
}

double log_support(const std::vector<BlockChange>& blocks, double gained) {
  const BlockChange all = sum_of(blocks);
  if (all.apart <= 0.0) return 0.0;
  // Largest over s of s r d - (s d)^2/2 - gained (s - 1)^2/2, with d the length of what the two
  // predict apart and r what was measured along it: fall = 2 r d - d^2.
  const double beyond = (all.fall - all.apart) * (all.fall - all.apart) / (4.0 * all.apart);
  const double known = std::max(0.0, gained);
  const double moved = beyond * all.apart / (all.apart + known);
  return log_ratio(all.fall + moved, all.apart, blocks);
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
