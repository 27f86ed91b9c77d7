// SPDX-License-Identifier: Apache-2.0
// A robot's side of the packets of dcnn-run, without a socket: what it sends, and what it believes.
#pragma once

#include <optional>

#include "dcnn/runtime/packet.h"

namespace dcnn {

/// Allocates nothing, throws nothing. Spans are valid until the next call.
class RobotSession {
 public:
  explicit RobotSession(const PacketKey& key) noexcept : key_(key) {}

  /// Asks for the session; the answer to it carries the same nonce. `now` in s.
  std::span<const std::uint8_t> hello(std::uint64_t nonce, double now) noexcept;
  /// Whether these bytes are the answer to the newest hello; then the session is theirs.
  bool take_welcome(std::span<const std::uint8_t> bytes) noexcept;
  bool open() const noexcept { return session_ != 0; }

  /// The next sample; open() only.
  std::span<const std::uint8_t> sample(const OnlineSample& sample) noexcept;
  /// Of the sample that was made last; 0 before the first one.
  std::uint64_t sequence() const noexcept { return sequence_; }
  /// A result that is authentic, of this session and newer than all before.
  std::optional<WireResult> take_result(std::span<const std::uint8_t> bytes) noexcept;

 private:
  PacketKey key_;
  PacketWriter out_{PacketHeader{}};
  std::uint64_t nonce_ = 0, session_ = 0, sequence_ = 0, newest_ = 0;
};

}  // namespace dcnn
