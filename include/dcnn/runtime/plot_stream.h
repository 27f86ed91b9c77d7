// SPDX-License-Identifier: Apache-2.0
// What a loop does, as JSON over UDP for live plots (PlotJuggler): sent by a thread of its own.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "dcnn/runtime/compensator.h"
#include "dcnn/runtime/udp.h"

namespace dcnn {

inline constexpr std::size_t kMostPlotBytes = 1024;

/// One cycle as a JSON object; its length. Numbers that are not finite are null.
std::size_t plot_text(const OnlineResult& result, double cycle_s, bool torque,
                      std::span<char, kMostPlotBytes> to) noexcept;

/// A ring with one writer, the control loop, and one reader, the thread that sends: neither waits
/// for the other. The loop copies a record and makes no system call; where the ring is full the
/// record is lost and counted.
class PlotStream {
 public:
  /// `address`: HOST:PORT or PORT, as UdpSocket reads it. Nobody needs to listen.
  PlotStream(const std::string& address, bool torque);
  ~PlotStream();  ///< sends what is left
  PlotStream(const PlotStream&) = delete;
  PlotStream& operator=(const PlotStream&) = delete;

  void put(const OnlineResult& result, double cycle_s) noexcept;
  std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kRecords = 4096;  // 8 s at 500 Hz
  struct Record {
    OnlineResult result;
    double cycle_s = 0.0;
  };

  bool drain() noexcept;
  void serve() noexcept;

  UdpSocket socket_;
  bool torque_;
  std::vector<Record> ring_;
  alignas(64) std::atomic<std::uint64_t> head_{0};  // records written; only the loop writes it
  alignas(64) std::atomic<std::uint64_t> tail_{0};  // records sent; only the thread writes it
  alignas(64) std::atomic<std::uint64_t> lost_{0};
  std::atomic<bool> stop_{false};
  std::thread sender_;  // last: everything it uses is there before it starts
};

}  // namespace dcnn
