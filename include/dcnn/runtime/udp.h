// SPDX-License-Identifier: Apache-2.0
// One UDP socket with one peer, and a robot's end of the conversation with dcnn-run.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "dcnn/runtime/robot_session.h"

namespace dcnn {

/// Seconds on the monotonic clock.
double monotonic_seconds() noexcept;

/// Error(kUsage) where a socket from one to the other cannot be: before anything else is waited
/// for.
void expect_addresses(const std::string& listen, const std::string& peer);

/// Bound to one address and connected to another: the kernel drops what comes from elsewhere.
class UdpSocket {
 public:
  /// HOST:PORT, [HOST]:PORT or PORT, which is on the loopback. Error(kUsage) for what is no
  /// address, Error(kFailure) for one that cannot be had.
  UdpSocket(const std::string& listen, const std::string& peer);
  ~UdpSocket();
  UdpSocket(UdpSocket&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  /// Two that speak with each other on the loopback, on ports that are free.
  static std::pair<UdpSocket, UdpSocket> pair();
  /// One that only sends, from any port that is free.
  static UdpSocket to(const std::string& peer);

  /// Waits for a datagram until `deadline` (monotonic_seconds(); the past: does not wait). Nothing
  /// when none came; a longer one than `buffer` is cut to it.
  std::optional<std::size_t> receive(std::span<std::uint8_t> buffer, double deadline) noexcept;
  bool send(std::span<const std::uint8_t> bytes) noexcept;

 private:
  explicit UdpSocket(int socket) : socket_(socket) {}

  int socket_ = -1;
};

/// What a robot's control loop needs: samples out, results in, the session kept.
class RobotLink {
 public:
  RobotLink(const std::string& listen, const std::string& peer, const PacketKey& key);

  /// Asks dcnn-run for its session until it answers; false when it does not within `seconds`.
  bool connect(double seconds);
  /// Seals and sends one sample; its sequence, 0 before connect().
  std::uint64_t send(const OnlineSample& sample) noexcept;
  /// The next result, waiting until `deadline` at most. Packets that are not authentic, of another
  /// session or older than one taken before are dropped.
  std::optional<WireResult> receive(double deadline) noexcept;

 private:
  UdpSocket socket_;
  RobotSession session_;
};

}  // namespace dcnn
