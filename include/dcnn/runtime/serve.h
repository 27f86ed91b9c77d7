// SPDX-License-Identifier: Apache-2.0
// The loops around an OnlineCompensator: packets, lines, and a rehearsal from a recording.
#pragma once

#include <functional>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"
#include "dcnn/runtime/plot_stream.h"
#include "dcnn/runtime/udp.h"

namespace dcnn {

/// Times of many cycles in fixed memory: bins of 2 % from 10 ns to 10 s.
class CycleTimes {
 public:
  void add(double seconds) noexcept;
  std::uint64_t count() const { return count_; }
  /// The time that a share q of the cycles does not exceed, s; 0 without cycles.
  double quantile(double q) const noexcept;
  double most() const { return most_; }
  Json to_json() const;

 private:
  static constexpr int kBins = 1050;
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double most_ = 0.0;
};

struct ServeOptions {
  std::string listen, peer;
  PacketKey key{};
  double latest = PacketGate::kOldest;  ///< s, most that a packet may come later than the fastest
  double seconds = 0.0;                 ///< 0: until stop() says so
  std::function<bool()> stop;
  PlotStream* plot = nullptr;  ///< told of every cycle
};

/// Answers every sample in its cycle; where none comes in time, tells the peer what the guard does
/// meanwhile. After start-up it makes no system call but to wait, receive, send and read the clock,
/// and allocates nothing. Cycles, states, verdicts on packets and thread CPU times as JSON.
Json serve_udp(OnlineCompensator& compensator, const ServeOptions& options);

/// Reads a header and rows as in a recording from one file descriptor, answers each row on the
/// other one: t, targets with _ext, state, reason, contact. `read` has the units of position and
/// angle and the sign of the force. A row that is no sample is a bad cycle, not an end.
/// Error(kData) for a header without a pose or force.
Json serve_lines(OnlineCompensator& compensator, int in, int out, const ReadOptions& read = {},
                 PlotStream* plot = nullptr);

/// Plays a recording forwards and backwards through packets on a loopback pair of sockets, as fast
/// as it goes, for so many cycles: what serve_udp() costs and whether memory grows.
Json rehearse(OnlineCompensator& compensator, const Recording& recording, std::uint64_t cycles);

/// What serve_udp(), serve_lines() or rehearse() report, in words.
std::string cycles_text(const Json& report);
/// Of a loop that never got beyond its warm-up, why, and what to look at; else "".
std::string warmup_text(const Json& report);
/// "34000 NETWORK, 51 WARMUP", without what never was; "none" where all is zero.
std::string counts_text(const Json& counts);
/// "p50 15 µs, p99 23 µs, p99.9 31 µs, most 110 µs", of CycleTimes.
std::string times_text(const Json& times);

}  // namespace dcnn
