// SPDX-License-Identifier: Apache-2.0
#include "experiment/peers/tables.h"

#include <cstdio>

#include "experiment/markup.h"

namespace dcnn {
namespace {

constexpr const char* kOurs = "dcnn";

std::string scientific(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

std::string in_us(double seconds) { return significant(1e6 * seconds, 4); }

std::vector<std::string> cells(const PeersRow& row, const std::string& name,
                               const CallTimes& times) {
  const double rate = row.products / times.median;
  return {row.network,
          std::to_string(row.batch),
          std::to_string(row.threads),
          name,
          in_us(times.median),
          in_us(times.p50),
          in_us(times.p99),
          in_us(times.maximum),
          significant(times.p99 / times.p50, 3),
          name == kOurs ? significant(row.loop_tail, 3) : "-",
          significant(1e-9 * rate, 3),
          significant(rate / row.peak, 2)};
}

}  // namespace

std::vector<std::string> peer_lines(const Peers& peers) {
  std::vector<std::string> lines;
  for (const Peer& peer : peers.peers) {
    if (!peer.missing.empty()) {
      lines.push_back(peer.name + " is left out: " + peer.missing);
      continue;
    }
    lines.push_back(peer.name + " " + peer.version + (peer.host.empty() ? "" : " in " + peer.host));
  }
  return lines;
}

PeerTable call_table(const Peers& peers) {
  PeerTable table{{"network", "batch", "threads", "library", "call [us]", "p50 [us]", "p99 [us]",
                   "max [us]", "p99/p50", "of a loop", "G products/s", "of peak", "ratio",
                   "overhead [us]", "net", "net of least", "difference"},
                  {}};
  for (const PeersRow& row : peers.rows) {
    auto ours = cells(row, kOurs, row.ours);
    ours.insert(ours.end(), {"1", "-", "1", "1", "-"});
    table.rows.push_back(std::move(ours));
    for (const PeerResult& peer : row.peers) {
      auto line = cells(row, peer.peer, peer.call);
      line.insert(line.end(),
                  {significant(peer.ratio, 3), peer.overhead > 0.0 ? in_us(peer.overhead) : "-",
                   significant(peer.ratio_net, 3), significant(peer.ratio_least, 3),
                   scientific(peer.difference) +
                       (peer.difference <= Peers::kTolerance ? "" : " (too much)")});
      table.rows.push_back(std::move(line));
    }
  }
  return table;
}

PeerTable epoch_table(const Peers& peers) {
  PeerTable table{{"training", "threads", "ours [s]", "of peak", "library", "theirs [s]", "ratio"},
                  {}};
  for (const EpochRow& row : peers.epochs) {
    table.rows.push_back({row.network, std::to_string(row.threads), significant(row.ours, 3),
                          significant(row.share_of_peak, 2), row.peer, significant(row.theirs, 3),
                          significant(row.ratio, 3)});
  }
  return table;
}

}  // namespace dcnn
