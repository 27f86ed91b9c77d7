// SPDX-License-Identifier: Apache-2.0
// Datagrams as they come, and the same under a right tag, as the holder of the key could send them.
#include "dcnn/runtime/packet.h"

#include <cmath>

#include "fuzz/support.h"
#include "sodium.h"

using namespace dcnn;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const PacketKey key{1, 2, 3};
  PacketGate gate(key, 7);
  std::uint64_t before = 0;
  double now = 0.0;
  while (size > 0) {
    // A byte of flags, a length, and so many bytes of packet.
    const std::uint8_t flags = data[0];
    const std::size_t length = size > 1 ? std::min<std::size_t>(data[1] * 2U, size - 2) : 0;
    std::array<std::uint8_t, kMostBytes> packet{};
    if (size > 2) std::copy_n(data + 2, length, packet.begin());
    data += std::min(size, length + 2);
    size -= std::min(size, length + 2);
    std::size_t total = length;
    if ((flags & 1) != 0 && total >= kTagBytes) {
      const std::size_t body = total - kTagBytes;
      crypto_generichash(&packet[body], kTagBytes, packet.data(), body, key.data(), key.size());
    }
    now += 0.001 * (flags >> 1);
    OnlineSample sample;
    const Verdict verdict = gate.judge({packet.data(), total}, now, sample);
    if (verdict == Verdict::kHello) gate.welcome();
    if (verdict == Verdict::kAccepted) {
      fuzz::demand(gate.last() > before, "a sequence that was taken already");
      fuzz::demand(sample.position.allFinite() && sample.wrench.allFinite(),
                   "an accepted sample that is not finite");
      fuzz::demand(std::abs(sample.quaternion.norm() - 1.0) < 0.01,
                   "an accepted sample without a pose");
      gate.answer({}, 1e-4);
    }
    before = gate.last();
  }
  return 0;
}
