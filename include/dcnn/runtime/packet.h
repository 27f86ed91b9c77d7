// SPDX-License-Identifier: Apache-2.0
// The packets of dcnn-run (docs/use/run.md): fixed little-endian layouts under a keyed tag.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "dcnn/runtime/compensator.h"

namespace dcnn {

/// 32 secret bytes that both ends hold.
using PacketKey = std::array<std::uint8_t, 32>;

/// Error(kUsage) unless the file is a regular one of 32 bytes that nobody but its owner can touch.
PacketKey read_packet_key(const std::filesystem::path& path);
/// Writes 32 random bytes with mode 0600; Error(kUsage) where the file exists.
void make_packet_key(const std::filesystem::path& path);

enum class PacketKind : std::uint16_t {
  kHello = 1,    ///< robot: asks for the session; carries a nonce
  kWelcome = 2,  ///< dcnn-run: the session, the last sequence it took, the nonce
  kSample = 3,   ///< robot: pose and wrench
  kResult = 4,   ///< dcnn-run: external wrench
  kExtra = 5,    ///< between programs of the user's own
};

/// The first 32 bytes of every packet.
struct PacketHeader {
  PacketKind kind = PacketKind::kHello;
  std::uint64_t session = 0, sequence = 0;
  double t = 0.0;  ///< s, the sender's clock; of a result: of the sample that it answers
};

constexpr std::size_t kHeaderBytes = 32, kTagBytes = 16;
constexpr std::size_t kHelloBytes = 56, kSampleBytes = 160, kResultBytes = 168;
constexpr std::size_t kMostBytes = 512;  ///< of any packet

/// A packet being written or read: fields in order, little-endian.
class PacketWriter {
 public:
  explicit PacketWriter(const PacketHeader& header) noexcept;
  void put(std::uint64_t value, int bytes) noexcept;
  void put(double value) noexcept;
  /// Appends the tag: BLAKE2b with the key over all before it.
  std::span<const std::uint8_t> seal(const PacketKey& key) noexcept;

 private:
  std::array<std::uint8_t, kMostBytes> bytes_;
  std::size_t size_ = 0;
};
class PacketReader {
 public:
  explicit PacketReader(std::span<const std::uint8_t> bytes) noexcept : bytes_(bytes) {}
  std::uint64_t take(int bytes) noexcept;  ///< zero beyond the end
  double take() noexcept;

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t place_ = 0;
};

/// Whether magic, version and tag are right. In constant time of the tag's bytes.
bool is_authentic(std::span<const std::uint8_t> bytes, const PacketKey& key) noexcept;
/// The header of bytes with the right magic and version, else nothing.
std::optional<PacketHeader> header_of(std::span<const std::uint8_t> bytes) noexcept;

/// A result as it travels.
struct WireResult {
  OnlineResult result;
  std::uint64_t answers = 0;  ///< sequence of the sample
  double seconds = 0.0;       ///< s, that dcnn-run took for it
};

void write_sample(const OnlineSample& sample, PacketWriter& packet) noexcept;
OnlineSample read_sample(std::span<const std::uint8_t> bytes) noexcept;  ///< kSampleBytes
void write_result(const WireResult& result, PacketWriter& packet) noexcept;
WireResult read_result(std::span<const std::uint8_t> bytes) noexcept;  ///< kResultBytes

/// What became of a packet.
enum class Verdict : std::uint8_t {
  kAccepted,
  kHello,    ///< authentic; to be answered with welcome()
  kLength,   ///< no packet has this length
  kFormat,   ///< another magic, version or kind
  kTag,      ///< not of the holder of the key, or changed on the way
  kSession,  ///< of another session: recorded earlier
  kReplay,   ///< this sequence or a newer one was taken already
  kLead,     ///< sequence too far ahead
  kStale,    ///< held back on the way
  kValue,    ///< not finite, or no pose
};
constexpr std::size_t kVerdicts = 10;
const char* name_of(Verdict verdict);

/// Decides for dcnn-run which datagrams are samples. Until a packet is accepted nothing changes but
/// the counts. Allocates nothing.
class PacketGate {
 public:
  static constexpr std::uint64_t kWindow = 1000;  ///< most that a sequence may lead
  static constexpr double kOldest =
      0.02;  ///< s, most that a packet may come later than the fastest
  static constexpr double kForgotten = 0.5;  ///< s of silence after which clocks are compared anew

  /// A session is named by a random number: packets of earlier ones are worth nothing.
  PacketGate(const PacketKey& key, std::uint64_t session, double latest = kOldest)
      : key_(key), session_(session), latest_(latest) {}

  /// `now` on the receiver's clock, s. The sample is set when accepted.
  Verdict judge(std::span<const std::uint8_t> bytes, double now, OnlineSample& sample) noexcept;
  /// The answer to the hello that was judged last.
  std::span<const std::uint8_t> welcome() noexcept;
  /// The packet that carries a result.
  std::span<const std::uint8_t> answer(const OnlineResult& result, double seconds) noexcept;

  std::uint64_t last() const { return last_; }
  std::uint64_t count(Verdict verdict) const { return counts_[static_cast<std::size_t>(verdict)]; }

 private:
  Verdict examine(std::span<const std::uint8_t> bytes, double now, OnlineSample& sample) noexcept;
  Verdict tell_age(double sent, double now) noexcept;

  PacketKey key_;
  std::uint64_t session_, last_ = 0, answered_ = 0, nonce_ = 0;
  double latest_;  // s
  double least_skew_ = 0.0, heard_ = -1e300;
  std::array<std::uint64_t, kVerdicts> counts_{};
  PacketWriter out_{PacketHeader{}};
};

}  // namespace dcnn
