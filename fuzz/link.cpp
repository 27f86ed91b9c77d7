// SPDX-License-Identifier: Apache-2.0
// What comes back to a robot from dcnn-run, and to dcnn-run from a robot: welcomes and results as
// they come, and the same under a right tag; the robot's own packets, changed on the way.
#include <algorithm>
#include <vector>

#include "dcnn/runtime/robot_session.h"
#include "fuzz/support.h"
#include "sodium.h"

using namespace dcnn;

namespace {

const PacketKey kKey{1, 2, 3};
constexpr std::uint64_t kSession = 7, kNonce = 11;

/// Steps of a conversation, each chosen by a byte.
class Conversation {
 public:
  void turn(std::uint8_t step, std::span<const std::uint8_t> bytes) {
    switch (step % 6) {
      case 0:
        robot_.hello(kNonce, now_);
        break;
      case 1:
        deliver(robot_.hello(kNonce, now_), bytes);
        break;
      case 2:
        if (robot_.open()) deliver(robot_.sample(sample_), bytes);
        break;
      case 3:
        receive(bytes, false);
        break;
      case 4:
        receive(bytes, true);
        break;
      default:
        now_ += 0.001 * static_cast<double>(bytes.size());
    }
  }

 private:
  /// A packet of the robot at dcnn-run, some of its bytes exchanged; and the answer at the robot.
  void deliver(std::span<const std::uint8_t> packet, std::span<const std::uint8_t> bytes) {
    std::vector<std::uint8_t> sent(packet.begin(), packet.end());
    for (std::size_t k = 0; k + 1 < bytes.size(); k += 2)
      sent[bytes[k] % sent.size()] ^= bytes[k + 1];
    const bool whole = std::equal(sent.begin(), sent.end(), packet.begin());
    OnlineSample taken;
    const Verdict verdict = gate_.judge(sent, now_, taken);
    fuzz::demand(whole || verdict != Verdict::kAccepted, "a changed packet that is taken");
    if (verdict == Verdict::kHello) {
      const auto welcome = gate_.welcome();
      fuzz::demand(robot_.take_welcome(welcome), "an honest welcome that is refused");
      fuzz::demand(robot_.sequence() == gate_.last(), "a welcome that loses the sequence");
    }
    if (verdict == Verdict::kAccepted) {
      fuzz::demand(taken.wrench == sample_.wrench, "a sample that arrives otherwise");
      OnlineResult result;
      result.external[0] = now_;
      const auto back = robot_.take_result(gate_.answer(result, 0.0));
      fuzz::demand(!back || back->result.external[0] == now_, "a result that arrives otherwise");
    }
  }

  void receive(std::span<const std::uint8_t> bytes, bool under_the_key) {
    std::vector<std::uint8_t> packet(bytes.begin(), bytes.end());
    if (under_the_key && packet.size() >= kTagBytes) {
      const std::size_t body = packet.size() - kTagBytes;
      crypto_generichash(&packet[body], kTagBytes, packet.data(), body, kKey.data(), kKey.size());
    }
    const bool welcomed = robot_.take_welcome(packet);
    const auto result = robot_.take_result(packet);
    fuzz::demand(under_the_key || (!welcomed && !result), "a packet without the key that is taken");
    if (result) {
      fuzz::demand(std::string_view(name_of(result->result.state)).size() > 3, "no state");
      fuzz::demand(name_of(result->result.reason) != nullptr, "no reason");
      fuzz::demand(!robot_.take_result(packet), "a result that is taken twice");
    }
  }

  PacketGate gate_{kKey, kSession};
  RobotSession robot_{kKey};
  OnlineSample sample_;
  double now_ = 0.0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Conversation conversation;
  while (size > 0) {
    // A byte of what is done, a length, and so many bytes.
    const std::size_t length = size > 1 ? std::min<std::size_t>(data[1], size - 2) : 0;
    conversation.turn(data[0], {data + std::min<std::size_t>(size, 2), length});
    const std::size_t used = std::min(size, length + 2);
    data += used;
    size -= used;
  }
  return 0;
}
