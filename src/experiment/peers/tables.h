// SPDX-License-Identifier: Apache-2.0
// What the printed comparison and the page have in common.
#pragma once

#include <string>
#include <vector>

#include "dcnn/experiment/peers.h"

namespace dcnn {

struct PeerTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

inline constexpr const char* kCallNote =
    "Times of a call: medians of stretches in turns (call) and single calls (p50, p99, max); of a "
    "loop: p99/p50 of one that needs the processor alone and takes as long, right after ours. "
    "ratio: median over turns of a library's time over ours; overhead: of a call through its host "
    "that does nothing, in the same turns; net: the ratio without it; net of least: the same of "
    "the least times. difference: of its outputs from ours, the greatest over the greatest output.";
inline constexpr const char* kEpochNote =
    "Epochs of 41729 samples in turns, medians; ratio: median of the ratios of neighbours.";

/// One line a library: version and overhead, or what to install.
std::vector<std::string> peer_lines(const Peers& peers);
PeerTable call_table(const Peers& peers);
PeerTable epoch_table(const Peers& peers);

}  // namespace dcnn
