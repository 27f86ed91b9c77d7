// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/packet.h"

#include <sodium.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/checks.h"

namespace dcnn {
namespace {

constexpr std::uint64_t kMagic = 0x4E4E4344;  // "DCNN"
constexpr std::uint64_t kVersion = 1;

void put(PacketWriter& packet, const auto& vector) noexcept {
  for (const double value : vector) packet.put(value);
}

void take(PacketReader& packet, auto& vector) noexcept {
  for (double& value : vector) value = packet.take();
}

}  // namespace

PacketWriter::PacketWriter(const PacketHeader& header) noexcept {
  put(kMagic, 4);
  put(kVersion, 2);
  put(static_cast<std::uint64_t>(header.kind), 2);
  put(header.session, 8);
  put(header.sequence, 8);
  put(header.t);
}

void PacketWriter::put(std::uint64_t value, int bytes) noexcept {
  for (int i = 0; i < bytes && size_ + kTagBytes < kMostBytes; ++i) {
    bytes_[size_++] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

void PacketWriter::put(double value) noexcept { put(std::bit_cast<std::uint64_t>(value), 8); }

std::span<const std::uint8_t> PacketWriter::seal(const PacketKey& key) noexcept {
  crypto_generichash(&bytes_[size_], kTagBytes, bytes_.data(), size_, key.data(), key.size());
  return {bytes_.data(), size_ + kTagBytes};
}

std::uint64_t PacketReader::take(int bytes) noexcept {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes && place_ < bytes_.size(); ++i) {
    value |= static_cast<std::uint64_t>(bytes_[place_++]) << (8 * i);
  }
  return value;
}

double PacketReader::take() noexcept { return std::bit_cast<double>(take(8)); }

std::optional<PacketHeader> header_of(std::span<const std::uint8_t> bytes) noexcept {
  PacketReader packet(bytes);
  if (bytes.size() < kHeaderBytes + kTagBytes || packet.take(4) != kMagic ||
      packet.take(2) != kVersion) {
    return std::nullopt;
  }
  PacketHeader header;
  header.kind = static_cast<PacketKind>(packet.take(2));
  header.session = packet.take(8);
  header.sequence = packet.take(8);
  header.t = packet.take();
  return header;
}

bool is_authentic(std::span<const std::uint8_t> bytes, const PacketKey& key) noexcept {
  if (!header_of(bytes)) return false;
  std::array<std::uint8_t, kTagBytes> tag;
  const std::size_t body = bytes.size() - kTagBytes;
  crypto_generichash(tag.data(), tag.size(), bytes.data(), body, key.data(), key.size());
  return sodium_memcmp(tag.data(), bytes.data() + body, kTagBytes) == 0;
}

void write_sample(const OnlineSample& sample, PacketWriter& packet) noexcept {
  put(packet, sample.position);
  put(packet, sample.quaternion);
  put(packet, sample.wrench);
  packet.put(sample.rearm ? 1 : 0, 8);
}

OnlineSample read_sample(std::span<const std::uint8_t> bytes) noexcept {
  OnlineSample sample;
  PacketReader packet(bytes.subspan(kHeaderBytes - 8));
  sample.t = packet.take();
  take(packet, sample.position);
  take(packet, sample.quaternion);
  take(packet, sample.wrench);
  sample.rearm = (packet.take(8) & 1) != 0;
  return sample;
}

void write_result(const WireResult& wire, PacketWriter& packet) noexcept {
  const OnlineResult& result = wire.result;
  packet.put(wire.answers, 8);
  put(packet, result.external);
  put(packet, result.bias);
  packet.put(result.novelty);
  packet.put(wire.seconds);
  packet.put(static_cast<std::uint64_t>(result.state), 1);
  packet.put(static_cast<std::uint64_t>(result.reason), 1);
  packet.put(result.contact ? 1 : 0, 1);
  packet.put(result.limited ? 1 : 0, 1);
  packet.put(0, 4);
  packet.put(0, 8);
  packet.put(0, 8);
}

WireResult read_result(std::span<const std::uint8_t> bytes) noexcept {
  WireResult wire;
  PacketReader packet(bytes.subspan(kHeaderBytes - 8));
  wire.result.t = packet.take();
  wire.answers = packet.take(8);
  take(packet, wire.result.external);
  take(packet, wire.result.bias);
  wire.result.novelty = packet.take();
  wire.seconds = packet.take();
  wire.result.state = static_cast<RunState>(std::min<std::uint64_t>(packet.take(1), 5));
  wire.result.reason = static_cast<Reason>(std::min<std::uint64_t>(packet.take(1), 13));
  wire.result.contact = packet.take(1) != 0;
  wire.result.limited = packet.take(1) != 0;
  return wire;
}

const char* name_of(Verdict verdict) {
  constexpr const char* kNames[kVerdicts] = {"accepted", "hello",  "length", "format", "tag",
                                             "session",  "replay", "lead",   "stale",  "value"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Verdict PacketGate::judge(std::span<const std::uint8_t> bytes, double now,
                          OnlineSample& sample) noexcept {
  const Verdict verdict = examine(bytes, now, sample);
  ++counts_[static_cast<std::size_t>(verdict)];
  return verdict;
}

Verdict PacketGate::examine(std::span<const std::uint8_t> bytes, double now,
                            OnlineSample& sample) noexcept {
  if (bytes.size() != kSampleBytes && bytes.size() != kHelloBytes) return Verdict::kLength;
  const auto header = header_of(bytes);
  const auto kind = bytes.size() == kSampleBytes ? PacketKind::kSample : PacketKind::kHello;
  if (!header || header->kind != kind) return Verdict::kFormat;
  if (!is_authentic(bytes, key_)) return Verdict::kTag;
  if (kind == PacketKind::kHello) {
    nonce_ = PacketReader(bytes.subspan(kHeaderBytes)).take(8);
    return Verdict::kHello;
  }
  if (header->session != session_) return Verdict::kSession;
  if (header->sequence <= last_) return Verdict::kReplay;
  if (header->sequence - last_ > kWindow) return Verdict::kLead;
  const OnlineSample candidate = read_sample(bytes);
  if (!is_possible(candidate)) return Verdict::kValue;
  const Verdict age = tell_age(header->t, now);
  if (age != Verdict::kAccepted) return age;
  last_ = header->sequence;
  sample = candidate;
  return Verdict::kAccepted;
}

/// Two clocks differ by an offset that the fastest packet shows; 100 ppm let it drift.
Verdict PacketGate::tell_age(double sent, double now) noexcept {
  constexpr double kDrift = 1e-4;
  const double skew = now - sent, silence = now - heard_;
  double least = std::min(skew, least_skew_ + kDrift * silence);
  if (silence > kForgotten) least = skew;
  if (skew - least > latest_) return Verdict::kStale;
  least_skew_ = least;
  heard_ = now;
  return Verdict::kAccepted;
}

std::span<const std::uint8_t> PacketGate::welcome() noexcept {
  out_ = PacketWriter({PacketKind::kWelcome, session_, last_, 0.0});
  out_.put(nonce_, 8);
  return out_.seal(key_);
}

std::span<const std::uint8_t> PacketGate::answer(const OnlineResult& result,
                                                 double seconds) noexcept {
  out_ = PacketWriter({PacketKind::kResult, session_, ++answered_, result.t});
  write_result({result, last_, seconds}, out_);
  return out_.seal(key_);
}

}  // namespace dcnn
