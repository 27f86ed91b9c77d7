// SPDX-License-Identifier: Apache-2.0
// The comparison as JSON, as tables and as charts.
#include <algorithm>
#include <cstdio>

#include "dcnn/experiment/peers.h"
#include "experiment/markup.h"
#include "experiment/peers/tables.h"

namespace dcnn {
namespace {

Json times_json(const CallTimes& times) {
  return {{"median_s", times.median},
          {"least_s", times.least},
          {"p50_s", times.p50},
          {"p99_s", times.p99},
          {"max_s", times.maximum}};
}

Json call_json(const PeersRow& row) {
  Json json = {{"network", row.network},
               {"batch", row.batch},
               {"threads", row.threads},
               {"products", row.products},
               {"products_per_s", row.rate()},
               {"peak_products_per_s", row.peak},
               {"share_of_peak", row.rate() / row.peak},
               {"ours", times_json(row.ours)},
               {"p99_over_p50", row.ours.p99 / row.ours.p50},
               {"p99_over_p50_of_a_loop", row.loop_tail},
               {"peers", Json::array()}};
  for (const PeerResult& peer : row.peers) {
    Json result = {{"peer", peer.peer}};
    result.update(times_json(peer.call));
    result.update({{"ratio", peer.ratio},
                   {"overhead_s", peer.overhead},
                   {"ratio_without_overhead", peer.ratio_net},
                   {"ratio_of_least", peer.ratio_least},
                   {"difference", peer.difference}});
    json["peers"].push_back(result);
  }
  return json;
}

/// Lines of a table, columns one under another.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines) {
    for (std::size_t k = 0; k < line.size(); ++k) widths[k] = std::max(widths[k], line[k].size());
  }
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k) text += padded(line[k], widths[k] + 2);
    text += line.back() + "\n";
  }
  return text;
}

std::string aligned(const PeerTable& table) {
  std::vector<std::vector<std::string>> lines{table.header};
  lines.insert(lines.end(), table.rows.begin(), table.rows.end());
  return aligned(lines);
}

}  // namespace

Json to_json(const Peers& peers) {
  Json json = {{"tolerance", Peers::kTolerance}, {"agree", peers.agree()},
               {"peers", Json::array()},         {"rows", Json::array()},
               {"epochs", Json::array()},        {"notes", peers.notes}};
  for (const Peer& peer : peers.peers) {
    const auto text = [](const std::string& value) { return value.empty() ? Json() : Json(value); };
    json["peers"].push_back({{"name", peer.name},
                             {"version", text(peer.version)},
                             {"missing", text(peer.missing)},
                             {"host", text(peer.host)}});
  }
  for (const PeersRow& row : peers.rows) json["rows"].push_back(call_json(row));
  for (const EpochRow& row : peers.epochs) {
    json["epochs"].push_back({{"network", row.network},
                              {"peer", row.peer},
                              {"threads", row.threads},
                              {"ours_s", row.ours},
                              {"theirs_s", row.theirs},
                              {"ratio", row.ratio},
                              {"share_of_peak", row.share_of_peak}});
  }
  return json;
}

std::string to_text(const Peers& peers) {
  std::string text;
  for (const std::string& line : peer_lines(peers)) text += line + "\n";
  if (!peers.rows.empty()) text += "\n" + aligned(call_table(peers)) + kCallNote + "\n";
  if (!peers.epochs.empty()) text += "\n" + aligned(epoch_table(peers)) + kEpochNote + "\n";
  for (const auto& note : peers.notes) text += note + "\n";
  return text;
}

}  // namespace dcnn
