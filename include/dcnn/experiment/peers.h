// SPDX-License-Identifier: Apache-2.0
// Predictions and training epochs beside those of other libraries, in turns in one run.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/core/parallel.h"
#include "dcnn/experiment/bench.h"
#include "dcnn/experiment/report.h"

namespace dcnn {

struct PeersRequest {
  /// Trained models whose networks are compared; without, the networks of the paper with drawn
  /// weights (times do not depend on them).
  std::vector<std::filesystem::path> models;
  /// Of the paper's networks and trainings those of these names alone; all where there is none.
  std::vector<std::string> networks;
  std::filesystem::path helpers;  ///< folder with the programs dcnn-peer-<library>
  std::vector<Index> batches{1, 10, 100, 1000, 10000, kPaperTestSamples};  ///< samples per call
  int rounds = 25;  ///< turns of every library for each row
  int epochs = 3;   ///< epochs of each in turn for each network that is trained; 0 for none
  std::uint64_t seed = 1;
  std::function<bool()> stop_wanted;  ///< asked before every row; may be empty
};

/// A library, or why it is not there.
struct Peer {
  std::string name, version;
  std::string missing;  ///< what to install; empty where it is there
  std::string host;     ///< the program its calls go through
  bool trains = false;
};

/// Times of one call [s]: median and least of stretches of calls, and single calls.
struct CallTimes {
  double median = 0.0, least = 0.0, p50 = 0.0, p99 = 0.0, maximum = 0.0;
};

/// What one library did in a row of the comparison.
struct PeerResult {
  std::string peer;
  CallTimes call;
  double ratio = 0.0;  ///< median over rounds of its time over ours
  /// Of a call of a network that does nothing, measured in the same turns, where calls go through
  /// a host [s].
  double overhead = 0.0;
  double ratio_net = 0.0;  ///< the ratio without it
  /// The same of the least times: what others take of a busy machine hardly counts in it.
  double ratio_least = 0.0;
  /// Greatest difference from our outputs over the greatest of our outputs; NaN where not compared.
  double difference = 0.0;
};

/// One network at one number of samples per call.
struct PeersRow {
  std::string network;
  Index batch = 1;
  int threads = 1;
  double products = 0.0;  ///< multiply-adds of a call, those with zeros of padding left out
  double peak = 0.0;  ///< multiply-adds per second of so many threads, measured in the same turns
  CallTimes ours;
  /// p99 over p50 of a loop of arithmetic as long as our call, right after our single calls: what
  /// the machine adds.
  double loop_tail = 0.0;
  std::vector<PeerResult> peers;

  double rate() const { return products / ours.median; }
};

/// Epochs of the same training: 41729 samples, noise-free, dropout, Adam.
struct EpochRow {
  std::string network, peer;
  int threads = 1;
  double ours = 0.0, theirs = 0.0;  ///< medians [s]
  double ratio = 0.0;               ///< median of the ratios of neighbours
  double share_of_peak = 0.0;       ///< of our best epoch
};

struct Peers {
  static constexpr double kTolerance = 1e-6;  ///< on PeerResult::difference
  std::vector<Peer> peers;
  std::vector<PeersRow> rows;
  std::vector<EpochRow> epochs;
  std::vector<std::string> notes;

  const Peer& peer(const std::string& name) const;
  bool agree() const;  ///< no difference is beyond the tolerance
};

/// Works in a temporary folder, which is gone when it ends; Error(kFailure) where a stop was
/// wanted.
Peers compare_with_peers(const PeersRequest& request,
                         const std::function<void(double done, const std::string& what)>& progress);

Json to_json(const Peers& peers);
std::string to_text(const Peers& peers);
/// Charts and tables, under a heading of their own.
void add_to(HtmlReport& page, const Peers& peers);

}  // namespace dcnn
