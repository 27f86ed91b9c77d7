// SPDX-License-Identifier: Apache-2.0
// One direction of the network: packets of three numbers, late, out of order or lost.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "dcnn/core/parallel.h"
#include "dcnn/core/random.h"

namespace dcnn {

/// What the receiver has at each tick: the newest packet that has arrived (by its number).
class Link {
 public:
  Link(Index delay, Index jitter, double loss, std::uint64_t seed, std::uint64_t direction)
      : delay_(delay),
        jitter_(jitter),
        loss_(loss),
        rng_({seed, direction}),
        slots_(static_cast<std::size_t>(delay + jitter + 1)) {}

  const Eigen::Matrix<double, 6, 1>& pass(const Eigen::Matrix<double, 6, 1>& sent) {
    const auto size = static_cast<Index>(slots_.size());
    if (!(loss_ > 0.0 && rng_.uniform() < loss_)) {
      const Index extra =
          jitter_ > 0 ? static_cast<Index>(rng_.below(static_cast<std::uint64_t>(jitter_ + 1))) : 0;
      Packet& slot = slots_[static_cast<std::size_t>((tick_ + delay_ + extra) % size)];
      slot = {tick_, sent};  // a newer one that arrives at the same tick replaces an older one
    }
    Packet& arriving = slots_[static_cast<std::size_t>(tick_ % size)];
    if (arriving.number > newest_) {
      newest_ = arriving.number;
      received_ = arriving.payload;
    }
    arriving.number = -1;
    ++tick_;
    return received_;
  }

 private:
  struct Packet {
    Index number = -1;
    Eigen::Matrix<double, 6, 1> payload = Eigen::Matrix<double, 6, 1>::Zero();
  };

  Index delay_, jitter_, tick_ = 0, newest_ = -1;
  double loss_;
  Rng rng_;
  std::vector<Packet> slots_;
  Eigen::Matrix<double, 6, 1> received_ = Eigen::Matrix<double, 6, 1>::Zero();
};

}  // namespace dcnn
