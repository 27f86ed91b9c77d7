// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/robot_session.h"

namespace dcnn {

std::span<const std::uint8_t> RobotSession::hello(std::uint64_t nonce, double now) noexcept {
  nonce_ = nonce;
  out_ = PacketWriter({PacketKind::kHello, 0, 0, now});
  out_.put(nonce, 8);
  return out_.seal(key_);
}

bool RobotSession::take_welcome(std::span<const std::uint8_t> bytes) noexcept {
  const auto header = header_of(bytes);
  if (bytes.size() != kHelloBytes || !header || header->kind != PacketKind::kWelcome ||
      header->session == 0 || !is_authentic(bytes, key_) ||
      PacketReader(bytes.subspan(kHeaderBytes)).take(8) != nonce_) {
    return false;
  }
  if (header->session != session_) newest_ = 0;
  session_ = header->session;
  sequence_ = header->sequence;
  return true;
}

std::span<const std::uint8_t> RobotSession::sample(const OnlineSample& sample) noexcept {
  out_ = PacketWriter({PacketKind::kSample, session_, ++sequence_, sample.t});
  write_sample(sample, out_);
  return out_.seal(key_);
}

std::optional<WireResult> RobotSession::take_result(std::span<const std::uint8_t> bytes) noexcept {
  const auto header = header_of(bytes);
  if (bytes.size() != kResultBytes || !header || header->kind != PacketKind::kResult || !open() ||
      header->session != session_ || header->sequence <= newest_ || !is_authentic(bytes, key_)) {
    return std::nullopt;
  }
  newest_ = header->sequence;
  return read_result(bytes);
}

}  // namespace dcnn
