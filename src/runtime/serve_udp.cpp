// SPDX-License-Identifier: Apache-2.0
#include <sodium.h>

#include <cmath>

#include "dcnn/runtime/serve.h"
#include "runtime/tally.h"

namespace dcnn {
namespace {

constexpr double kLate = 1.5;  // samples after the last one, when a cycle counts as missed

std::uint64_t random_number() {
  require(sodium_init() >= 0, Exit::kFailure, "no source of randomness");
  std::uint64_t number = 0;
  while (number == 0) randombytes_buf(&number, sizeof number);
  return number;
}

/// One conversation: gate, compensator, answers.
class Server {
 public:
  Server(OnlineCompensator& compensator, UdpSocket& socket, const ServeOptions& options)
      : compensator_(compensator),
        socket_(socket),
        gate_(options.key, random_number(), options.latest),
        plot_(options.plot) {}

  /// Waits for one datagram until `until` at most, or for the moment when a cycle is missed.
  void turn(double until) noexcept {
    const auto size = socket_.receive(buffer_, due_ > 0.0 ? std::min(due_, until) : until);
    const double now = monotonic_seconds();
    if (size) take({buffer_.data(), *size}, now);
    if (due_ > 0.0 && now >= due_) {
      ++tally_.misses;
      answer(compensator_.miss(), now, thread_seconds());
      due_ += compensator_.dt() * std::max(1.0, std::ceil((now - due_) / compensator_.dt()));
    }
  }

  Json report() const {
    Json json = tally_.to_json();
    json["packets"] = Json::object();
    for (std::size_t i = 0; i < kVerdicts; ++i) {
      const auto verdict = static_cast<Verdict>(i);
      json["packets"][name_of(verdict)] = gate_.count(verdict);
    }
    return json;
  }

 private:
  void take(std::span<const std::uint8_t> bytes, double now) noexcept {
    const double begin = thread_seconds();
    OnlineSample sample;
    const Verdict verdict = gate_.judge(bytes, now, sample);
    if (verdict == Verdict::kHello) socket_.send(gate_.welcome());
    if (verdict != Verdict::kAccepted) return;
    due_ = now + kLate * compensator_.dt();
    answer(compensator_.step(sample), now, begin);
  }

  void answer(const OnlineResult& result, double now, double begin) noexcept {
    tally_.add(result);
    const double taken = monotonic_seconds() - now;
    if (taken > compensator_.dt()) {
      ++tally_.overruns;
      compensator_.overrun();
    }
    socket_.send(gate_.answer(result, taken));
    const double cpu = thread_seconds() - begin;
    if (plot_) plot_->put(result, cpu);
    tally_.times.add(cpu);
  }

  OnlineCompensator& compensator_;
  UdpSocket& socket_;
  PacketGate gate_;
  PlotStream* plot_;
  Tally tally_;
  double due_ = 0.0;  // when the next sample is missed; 0 before the first one
  std::array<std::uint8_t, kMostBytes> buffer_;
};

}  // namespace

Json serve_udp(OnlineCompensator& compensator, const ServeOptions& options) {
  UdpSocket socket(options.listen, options.peer);
  Server server(compensator, socket, options);
  const double begin = monotonic_seconds();
  for (double now = begin; options.seconds <= 0.0 || now < begin + options.seconds;
       now = monotonic_seconds()) {
    if (options.stop && options.stop()) break;
    server.turn(now + 0.1);
  }
  return server.report();
}

}  // namespace dcnn
