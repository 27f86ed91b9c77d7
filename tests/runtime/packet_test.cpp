// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/packet.h"

#include <gtest/gtest.h>
#include <sodium.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "dcnn/core/random.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::uint64_t kSession = 0x1234567890ABCDEF;

PacketKey key_of(int n) {
  PacketKey key{};
  key[0] = static_cast<std::uint8_t>(n);
  return key;
}

Bytes sealed(std::uint64_t sequence, double t, std::uint64_t session = kSession, int key = 1,
             const OnlineSample& sample = {}) {
  PacketWriter packet({PacketKind::kSample, session, sequence, t});
  write_sample(sample, packet);
  const auto bytes = packet.seal(key_of(key));
  return {bytes.begin(), bytes.end()};
}

TEST(Packet, SamplesAndResultsArriveAsTheyWereSent) {
  OnlineSample sent;
  sent.t = 12.25;
  sent.position = {1, -2, 3};
  sent.quaternion = {0.5, -0.5, 0.5, 0.5};
  sent.wrench << 1, 2, 3, 4, 5, -6;
  sent.rearm = true;
  PacketGate gate(key_of(1), kSession);
  OnlineSample got;
  const Bytes bytes = sealed(1, sent.t, kSession, 1, sent);
  ASSERT_EQ(bytes.size(), kSampleBytes);
  ASSERT_EQ(gate.judge(bytes, 0.0, got), Verdict::kAccepted);
  EXPECT_EQ(got.t, sent.t);
  EXPECT_EQ(got.position, sent.position);
  EXPECT_EQ(got.quaternion, sent.quaternion);
  EXPECT_EQ(got.wrench, sent.wrench);
  EXPECT_TRUE(got.rearm);

  OnlineResult result;
  result.t = 12.25;
  result.external << 1, 2, 3, 4, 5, 6;
  result.state = RunState::kPhysics;
  result.reason = Reason::kEnvelope;
  result.contact = true;
  result.novelty = 1.5;
  result.bias = {0.1, 0.2, 0.3};
  const auto answer = gate.answer(result, 1e-5);
  ASSERT_EQ(answer.size(), kResultBytes);
  EXPECT_TRUE(is_authentic(answer, key_of(1)));
  EXPECT_FALSE(is_authentic(answer, key_of(2)));
  const WireResult wire = read_result(answer);
  EXPECT_EQ(wire.result.t, 12.25);
  EXPECT_EQ(wire.answers, 1U);
  EXPECT_EQ(wire.seconds, 1e-5);
  EXPECT_EQ(wire.result.external, result.external);
  EXPECT_EQ(wire.result.state, RunState::kPhysics);
  EXPECT_EQ(wire.result.reason, Reason::kEnvelope);
  EXPECT_TRUE(wire.result.contact);
  EXPECT_FALSE(wire.result.limited);
  EXPECT_EQ(wire.result.novelty, 1.5);
  EXPECT_EQ(wire.result.bias, result.bias);
}

TEST(Packet, TheLayoutIsTheOneInTheDocumentation) {
  const Bytes bytes = sealed(0x0807060504030201, 1.0);
  const std::uint8_t head[] = {'D', 'C', 'N', 'N', 1, 0, 3, 0};
  EXPECT_EQ(std::memcmp(bytes.data(), head, sizeof head), 0);
  EXPECT_EQ(bytes[8], 0xEF);   // session
  EXPECT_EQ(bytes[16], 0x01);  // sequence
  EXPECT_EQ(bytes[31], 0x3F);  // t = 1.0
  EXPECT_EQ(bytes[63], 0x3F);  // qw = 1.0
}

TEST(Packet, EveryFlippedBitIsRefused) {
  PacketGate gate(key_of(1), kSession);
  OnlineSample got;
  const Bytes whole = sealed(5, 0.0);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes bytes = whole;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    ASSERT_NE(gate.judge(bytes, 0.0, got), Verdict::kAccepted) << bit;
  }
  EXPECT_EQ(gate.last(), 0U);
  EXPECT_EQ(gate.judge(whole, 0.0, got), Verdict::kAccepted);
}

TEST(Packet, WhatIsNoSampleOfNowIsNamed) {
  PacketGate gate(key_of(1), kSession);
  OnlineSample got;
  const auto judge = [&](const Bytes& bytes, double now) { return gate.judge(bytes, now, got); };
  EXPECT_EQ(judge(sealed(10, 1.0), 5.0), Verdict::kAccepted);
  EXPECT_EQ(judge(sealed(10, 1.0), 5.0), Verdict::kReplay);
  EXPECT_EQ(judge(sealed(9, 1.002), 5.002), Verdict::kReplay);
  EXPECT_EQ(judge(sealed(11 + PacketGate::kWindow, 1.002), 5.002), Verdict::kLead);
  EXPECT_EQ(judge(sealed(10 + (1ULL << 63), 1.002), 5.002), Verdict::kLead);
  EXPECT_EQ(judge(sealed(11, 1.002, kSession + 1), 5.002), Verdict::kSession);
  EXPECT_EQ(judge(sealed(11, 1.002, kSession, 2), 5.002), Verdict::kTag);
  EXPECT_EQ(judge(sealed(11, 1.002), 5.002 + 2 * PacketGate::kOldest), Verdict::kStale);
  OnlineSample bad;
  bad.wrench[3] = NAN;
  EXPECT_EQ(judge(sealed(11, 1.002, kSession, 1, bad), 5.002), Verdict::kValue);
  bad = {};
  bad.quaternion *= 1.1;
  EXPECT_EQ(judge(sealed(11, 1.002, kSession, 1, bad), 5.002), Verdict::kValue);
  EXPECT_EQ(judge(sealed(11, NAN), 5.002), Verdict::kValue);
  EXPECT_EQ(judge(Bytes(kSampleBytes, 0), 5.002), Verdict::kFormat);
  EXPECT_EQ(judge(Bytes(), 5.002), Verdict::kLength);
  EXPECT_EQ(gate.last(), 10U);
  EXPECT_EQ(judge(sealed(11, 1.002), 5.003), Verdict::kAccepted);
  EXPECT_EQ(judge(sealed(12, -70.0), 6.0), Verdict::kAccepted);  // another clock after a silence
}

TEST(Packet, AHeaderNeedsRoomForItselfAndATag) {
  Bytes bytes = sealed(77, 2.5);
  const auto header = header_of(bytes);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->kind, PacketKind::kSample);
  EXPECT_EQ(header->session, kSession);
  EXPECT_EQ(header->sequence, 77U);
  EXPECT_EQ(header->t, 2.5);
  bytes.resize(kHeaderBytes + kTagBytes);
  EXPECT_TRUE(header_of(bytes));
  bytes.resize(kHeaderBytes + kTagBytes - 1);
  EXPECT_FALSE(header_of(bytes));
  EXPECT_FALSE(header_of(Bytes()));
}

/// The tag of the key's holder under something that is no packet of this program.
TEST(Packet, ATagMakesNoPacketOfWhatIsNone) {
  const PacketKey key = key_of(1);
  const auto tagged = [&](std::size_t place, std::uint8_t value) {
    Bytes bytes = sealed(1, 0.0);
    bytes[place] = value;
    const std::size_t body = bytes.size() - kTagBytes;
    crypto_generichash(&bytes[body], kTagBytes, bytes.data(), body, key.data(), key.size());
    return bytes;
  };
  EXPECT_TRUE(is_authentic(tagged(0, 'D'), key));
  EXPECT_FALSE(is_authentic(tagged(0, 'X'), key));  // magic
  EXPECT_FALSE(is_authentic(tagged(4, 2), key));    // version
  PacketGate gate(key, kSession);
  OnlineSample got;
  for (const int kind : {0, 1, 2, 4, 5, 255}) {
    EXPECT_EQ(gate.judge(tagged(6, static_cast<std::uint8_t>(kind)), 0.0, got), Verdict::kFormat)
        << kind;
  }
  EXPECT_EQ(gate.judge(tagged(7, 1), 0.0, got), Verdict::kFormat);
}

TEST(Packet, NoWriterWritesBeyondItsRoom) {
  PacketWriter packet({PacketKind::kExtra, 0, 0, 0.0});
  for (int k = 0; k < 200; ++k) packet.put(static_cast<double>(k));
  const auto bytes = packet.seal(key_of(1));
  EXPECT_EQ(bytes.size(), kMostBytes);
  EXPECT_TRUE(is_authentic(bytes, key_of(1)));
  PacketReader reader(bytes.first(3));
  EXPECT_EQ(reader.take(8), 0x4E4344U) << "zero beyond the end";
  EXPECT_EQ(reader.take(8), 0U);
}

/// The wire has more values than the enumerations.
TEST(Packet, AnUnknownStateOrReasonIsTheLastOne) {
  OnlineResult result;
  result.state = static_cast<RunState>(200);
  result.reason = static_cast<Reason>(200);
  result.limited = true;
  PacketGate gate(key_of(1), kSession);
  const WireResult wire = read_result(gate.answer(result, 0.0));
  EXPECT_EQ(wire.result.state, RunState::kFault);
  EXPECT_EQ(wire.result.reason, Reason::kLatched);
  EXPECT_TRUE(wire.result.limited);
  EXPECT_FALSE(wire.result.contact);
}

TEST(Packet, AWelcomeSaysTheSessionTheLastSequenceAndTheNonce) {
  PacketGate gate(key_of(1), kSession);
  OnlineSample got;
  ASSERT_EQ(gate.judge(sealed(5, 0.0), 0.0, got), Verdict::kAccepted);
  PacketWriter hello({PacketKind::kHello, 0, 0, 0.0});
  hello.put(0xABCDEF, 8);
  ASSERT_EQ(gate.judge(hello.seal(key_of(1)), 0.0, got), Verdict::kHello);
  const auto welcome = gate.welcome();
  ASSERT_EQ(welcome.size(), kHelloBytes);
  const auto header = header_of(welcome);
  EXPECT_EQ(header->kind, PacketKind::kWelcome);
  EXPECT_EQ(header->session, kSession);
  EXPECT_EQ(header->sequence, 5U);
  EXPECT_EQ(PacketReader(welcome.subspan(kHeaderBytes)).take(8), 0xABCDEFU);
  const auto first = header_of(gate.answer({}, 0.0))->sequence;
  EXPECT_EQ(header_of(gate.answer({}, 0.0))->sequence, first + 1);
  EXPECT_EQ(gate.count(Verdict::kAccepted), 1U);
  EXPECT_EQ(gate.count(Verdict::kHello), 1U);
  EXPECT_EQ(gate.count(Verdict::kTag), 0U);
}

/// The bounds themselves belong to what is taken.
TEST(Packet, TheWindowAndTheAgeEndWhereTheyAreSaidTo) {
  constexpr double kOldest = PacketGate::kOldest;
  OnlineSample got;
  PacketGate gate(key_of(1), kSession);
  EXPECT_EQ(gate.judge(sealed(PacketGate::kWindow, 0.0), 0.0, got), Verdict::kAccepted);
  EXPECT_EQ(gate.judge(sealed(2 * PacketGate::kWindow + 1, 0.0), 0.0, got), Verdict::kLead);
  EXPECT_EQ(gate.judge(sealed(2 * PacketGate::kWindow, 0.0), 0.0, got), Verdict::kAccepted);
  // Clocks may drift by 100 ppm: after 0.4 s the fastest packet is 40 us later than it was.
  for (const double later : {0.9, 1.1}) {
    PacketGate aged(key_of(1), kSession);
    ASSERT_EQ(aged.judge(sealed(1, 10.0), 3.0, got), Verdict::kAccepted);
    const double sent = 10.4, now = 3.4 + kOldest + later * 4e-5;
    EXPECT_EQ(aged.judge(sealed(2, sent), now, got),
              later < 1.0 ? Verdict::kAccepted : Verdict::kStale)
        << later;
  }
  // The latest is the caller's.
  PacketGate patient(key_of(1), kSession, 1.0);
  ASSERT_EQ(patient.judge(sealed(1, 0.0), 0.0, got), Verdict::kAccepted);
  EXPECT_EQ(patient.judge(sealed(2, 0.4), 0.4 + 0.3, got), Verdict::kAccepted);
  // A packet that is stale does not make the next one stale or fresh.
  PacketGate steady(key_of(1), kSession);
  ASSERT_EQ(steady.judge(sealed(1, 0.0), 0.0, got), Verdict::kAccepted);
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(steady.judge(sealed(2, 0.002), 0.1, got), Verdict::kStale);
  }
  EXPECT_EQ(steady.judge(sealed(2, 0.1), 0.1 + 0.5 * kOldest, got), Verdict::kAccepted);
  const double drift = 1e-4 * 0.25;  // after a quarter of a second
  PacketGate exact(key_of(1), kSession, 1.25 - drift);
  ASSERT_EQ(exact.judge(sealed(1, 0.0), 0.0, got), Verdict::kAccepted);
  EXPECT_EQ(exact.judge(sealed(2, -1.0), 0.25, got), Verdict::kAccepted);
  PacketGate still(key_of(1), kSession);
  ASSERT_EQ(still.judge(sealed(1, 0.0), 0.0, got), Verdict::kAccepted);
  EXPECT_EQ(still.judge(sealed(2, 0.0), PacketGate::kForgotten, got), Verdict::kStale);
  // Half a second of silence and less: the old comparison; more: a new one.
  for (const bool silent : {false, true}) {
    PacketGate waking(key_of(1), kSession);
    ASSERT_EQ(waking.judge(sealed(1, 0.0), 0.0, got), Verdict::kAccepted);
    const double now = silent ? 0.51 : 0.49;
    EXPECT_EQ(waking.judge(sealed(2, 0.0), now, got),
              silent ? Verdict::kAccepted : Verdict::kStale);
  }
}

TEST(Packet, ASequenceNearItsEndGoesOn) {
  PacketGate gate(key_of(1), kSession);
  OnlineSample got;
  EXPECT_EQ(gate.judge(sealed(900, 0.0), 0.0, got), Verdict::kAccepted);
  for (std::uint64_t k = 901; k < 2000; ++k) {
    ASSERT_EQ(gate.judge(sealed(k, 0.0), 0.0, got), Verdict::kAccepted);
  }
}

/// A hostile packet of one of many kinds; `last` is the newest sequence that was accepted.
Bytes hostile(Rng& rng, std::uint64_t last, double t, const Bytes& recorded) {
  OnlineSample bad;
  switch (rng.below(9)) {
    case 0: {  // any length, any bytes
      Bytes bytes(rng.below(600));
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(rng.bits());
      return bytes;
    }
    case 1:
      return sealed(last + 1, t, kSession, 2);  // wrong key
    case 2:
      return recorded;  // replay
    case 3:
      return sealed(last - std::min<std::uint64_t>(last, rng.below(50)), t);  // reorder
    case 4:
      return sealed(last + PacketGate::kWindow + 1 + rng.below(1ULL << 40), t);  // lead
    case 5:
      bad.position[static_cast<Index>(rng.below(3))] = rng.below(2) ? NAN : INFINITY;
      return sealed(last + 1, t, kSession, 1, bad);
    case 6:
      return sealed(last + 1, t, rng.bits() | 1);  // another session
    case 7: {                                      // cut or drawn out
      Bytes bytes = sealed(last + 1, t);
      bytes.resize(rng.below(300) == kSampleBytes ? 0 : rng.below(kSampleBytes));
      return bytes;
    }
    default: {  // one byte changed
      Bytes bytes = sealed(last + 1, t);
      bytes[rng.below(bytes.size())] ^= static_cast<std::uint8_t>(1 + rng.below(255));
      return bytes;
    }
  }
}

TEST(Packet, AMillionHostileOnesChangeNothingAndTheRightOnesAreTaken) {
  Rng rng(3);
  PacketGate gate(key_of(1), kSession);
  OnlineSample got;
  Bytes recorded = sealed(0, 0.0);
  std::uint64_t last = 0, taken = 0, legitimate = 0;
  for (int k = 0; k < test::repetitions(1000000); ++k) {
    const double t = 2e-5 * k;
    ASSERT_NE(gate.judge(hostile(rng, last, t, recorded), t, got), Verdict::kAccepted) << k;
    ASSERT_EQ(gate.last(), last) << k;
    if (k % 100 != 0) continue;  // 500 Hz among a flood
    recorded = sealed(++last, t);
    ++legitimate;
    taken += gate.judge(recorded, t, got) == Verdict::kAccepted;
  }
  EXPECT_EQ(taken, legitimate);
}

}  // namespace
}  // namespace dcnn
