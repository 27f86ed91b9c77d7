// SPDX-License-Identifier: Apache-2.0
// Streams of random numbers that one seed feeds: no two uses in a model may share a number.
#pragma once

#include <cstdint>

namespace dcnn {

enum RandomStream : std::uint64_t {
  // the trainer
  kShuffle = 1,
  kEpochLevel,
  kEpochNoise,
  kDropout,
  kCollectOrder,
  // networks
  kNetworkWeights = 100,
  // frame-tcn
  kTcnNoise = 110,
  kTcnGates = 112,
  kTcnHead,
  kTcnUnits,
  kTcnRidge,
  kTcnBins,
  // mixtures of line fits
  kMixtureNoise = 120,
  // protocol A: levels of rows
  kLevelOrder = 200,
  kLevelNoise,
  // shallow networks
  kShallowWeights = 300,
  kShallowDivision,
  kShallowNoise,
  // the linear skip's least squares: never in a shallow network
  kSkipNoise = 300,
};

}  // namespace dcnn
