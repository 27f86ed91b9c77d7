// SPDX-License-Identifier: Apache-2.0
// A robot at 500 Hz whose address somebody else floods with packets under a wrong key:
// dcnn_flood SERVER ROBOT KEY-FILE SECONDS RATE [PRIORITY]. Prints as JSON how many samples were
// answered within their cycle and later, and the packets that the flood sent.
#include <atomic>
#include <cmath>
#include <ctime>
#include <iostream>
#include <thread>

#include "dcnn/core/json.h"
#include "dcnn/runtime/realtime.h"
#include "dcnn/runtime/udp.h"

namespace {

using namespace dcnn;

constexpr double kCycle = 0.002;  // s

void sleep_until(double moment) {
  const double whole = std::floor(moment);
  const timespec until{static_cast<time_t>(whole), static_cast<long>(1e9 * (moment - whole))};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

/// Sends `rate` packets a second, in a burst each 100 us, until it is told to end.
class Flood {
 public:
  Flood(UdpSocket& socket, const PacketKey& wrong, double rate)
      : thread_([this, &socket, wrong, rate] {
          RobotSession stranger(wrong);
          const double begin = monotonic_seconds();
          while (!end_) {
            const auto due = static_cast<std::uint64_t>(rate * (monotonic_seconds() - begin));
            for (; sent_ < due; ++sent_) socket.send(stranger.sample({}));
            sleep_until(monotonic_seconds() + 1e-4);
          }
        }) {}
  ~Flood() { stop(); }
  std::uint64_t stop() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
    return sent_;
  }

 private:
  std::atomic<bool> end_{false};
  std::uint64_t sent_ = 0;
  std::thread thread_;  // last: what it uses is there before it starts
};

/// The tool at rest under a constant pull of 1 N: the answer is known.
OnlineSample sample_at(double t) {
  OnlineSample sample;
  sample.t = t;
  sample.position = {0.1, 0.0, 0.3};
  sample.wrench[0] = 1.0;
  return sample;
}

bool connect(UdpSocket& socket, RobotSession& session) {
  std::array<std::uint8_t, kMostBytes> buffer;
  for (int tries = 0; tries < 200; ++tries) {
    const double now = monotonic_seconds();
    socket.send(session.hello(static_cast<std::uint64_t>(1e9 * now), now));
    while (const auto size = socket.receive(buffer, now + 0.1)) {
      if (session.take_welcome({buffer.data(), *size})) return true;
    }
  }
  return false;
}

Json converse(UdpSocket& socket, RobotSession& session, double seconds) {
  std::array<std::uint8_t, kMostBytes> buffer;
  const auto cycles = static_cast<std::uint64_t>(seconds / kCycle);
  std::uint64_t in_time = 0, later = 0, wrong = 0;
  const double begin = monotonic_seconds() + 0.05;
  for (std::uint64_t k = 0; k < cycles; ++k) {
    const double due = begin + kCycle * static_cast<double>(k);
    sleep_until(due);
    socket.send(session.sample(sample_at(kCycle * static_cast<double>(k))));
    while (const auto size = socket.receive(buffer, due + kCycle)) {
      const auto wire = session.take_result({buffer.data(), *size});
      if (!wire) continue;
      wrong += !(wire->result.external.cwiseAbs().maxCoeff() <= 50.0);
      if (wire->answers == session.sequence()) {
        ++in_time;
        break;
      }
      later += wire->answers > 0;
    }
  }
  return {
      {"samples", cycles}, {"answered_in_their_cycle", in_time}, {"late", later}, {"wrong", wrong}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) return 2;
  try {
    UdpSocket socket(argv[2], argv[1]);
    const PacketKey key = read_packet_key(argv[3]);
    PacketKey wrong = key;
    wrong[0] ^= 1;
    RobotSession session(key);
    if (!connect(socket, session)) fail(Exit::kFailure, argv[1], ": no answer");
    Flood flood(socket, wrong, std::atof(argv[5]));
    if (argc > 6) become_realtime(std::atoi(argv[6]));  // after the flood has its usual priority
    Json report = converse(socket, session, std::atof(argv[4]));
    report["flood"] = flood.stop();
    std::cout << report.dump() << "\n";
    return 0;
  } catch (const Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
