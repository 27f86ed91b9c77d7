// SPDX-License-Identifier: Apache-2.0
#include "dcnn/teleop/live.h"

#include <cerrno>
#include <ctime>

#include "dcnn/runtime/serve.h"
#include "teleop/sides.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

constexpr double kPatience = 10.0;  // s, for the others to start
constexpr double kShare = 0.45;     // of a tick, that each of the two answers may take

void sleep_until(double moment) {
  const auto whole = static_cast<time_t>(moment);
  const timespec until{whole, static_cast<long>(1e9 * (moment - static_cast<double>(whole)))};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

/// Packets of user kind with a number that grows; a fresh key for each run keeps old ones out.
class Exchange {
 public:
  Exchange(const Ends& ends, const PacketKey& key) : socket_(ends.listen, ends.peer), key_(key) {}

  template <class... Vectors>
  void send(std::uint64_t number, const Vectors&... vectors) {
    PacketWriter packet({PacketKind::kExtra, 0, number, 0.0});
    const auto put = [&](const auto& vector) {
      for (const double value : vector) packet.put(value);
    };
    (put(vectors), ...);
    socket_.send(packet.seal(key_));
  }

  /// The packet of this number, or any newer one than before where it is 0; its number, 0 for none.
  template <class... Vectors>
  std::uint64_t receive(std::uint64_t number, double deadline, Vectors&... vectors) {
    while (const auto size = socket_.receive(buffer_, deadline)) {
      const std::span<const std::uint8_t> bytes(buffer_.data(), *size);
      const auto header = header_of(bytes);
      const std::size_t wanted =
          kHeaderBytes + kTagBytes + 8 * static_cast<std::size_t>((vectors.size() + ...));
      if (*size != wanted || !header || header->kind != PacketKind::kExtra ||
          header->sequence <= newest_ || !is_authentic(bytes, key_)) {
        continue;
      }
      newest_ = header->sequence;
      PacketReader packet(bytes.subspan(kHeaderBytes));
      const auto take = [&](auto& vector) {
        for (double& value : vector) value = packet.take();
      };
      (take(vectors), ...);
      if (number == 0 || newest_ == number) return newest_;
    }
    return 0;
  }

 private:
  UdpSocket socket_;
  PacketKey key_;
  std::uint64_t newest_ = 0;
  std::array<std::uint8_t, kMostBytes> buffer_;
};

OnlineSample sample_of(SlaveSide& slave, double t) {
  OnlineSample sample;
  sample.t = t;
  sample.position = slave.body().x;
  sample.quaternion = quaternion_from_euler(slave.orientation());
  sample.wrench.head<3>() = slave.measured();
  return sample;
}

/// Counts and times of a run at 500 Hz.
struct LiveTimes {
  CycleTimes jitter, identifier, controller;
  std::uint64_t identifier_misses = 0, controller_misses = 0, overruns = 0;
  std::array<std::uint64_t, 6> states{};

  Json to_json(Index ticks) const {
    Json json = {{"ticks", ticks},
                 {"identifier_misses", identifier_misses},
                 {"controller_misses", controller_misses},
                 {"overruns", overruns},
                 {"wake_up_jitter", jitter.to_json()},
                 {"identifier_round_trip", identifier.to_json()},
                 {"controller_round_trip", controller.to_json()},
                 {"states", Json::object()}};
    for (std::size_t i = 0; i < states.size(); ++i) {
      json["states"][name_of(static_cast<RunState>(i))] = states[i];
    }
    return json;
  }
};

}  // namespace

Json run_live_sensor(const TeleopConfig& config, const Ends& identifier, const Ends& controller,
                     const PacketKey& key, std::uint64_t seed) {
  RobotLink link(identifier.listen, identifier.peer, key);
  require(link.connect(kPatience), Exit::kFailure, "dcnn-run does not answer at ", identifier.peer,
          "; start it with the same key");
  Exchange other(controller, key);
  SlaveSide slave(config, seed);
  LiveTimes times;
  Vector3d estimated = Vector3d::Zero();
  Command command = Command::Zero();
  const auto ticks = static_cast<Index>(std::lround(config.duration_s / kTeleopTick));
  double start = monotonic_seconds() + 0.1;
  for (Index k = 0; k < ticks; ++k) {
    const double t = static_cast<double>(k) * kTeleopTick, due = start + t;
    sleep_until(due);
    const double woke = monotonic_seconds();
    times.jitter.add(woke - due);
    slave.begin(t);
    const std::uint64_t asked = link.send(sample_of(slave, t));
    bool answered = false;
    while (const auto wire = link.receive(due + kShare * kTeleopTick)) {
      estimated = wire->result.external.head<3>();
      ++times.states[static_cast<std::size_t>(wire->result.state)];
      answered = wire->answers == asked;
      if (answered) break;
    }
    const double identified = monotonic_seconds();
    answered ? times.identifier.add(identified - woke) : void(++times.identifier_misses);
    const auto number = static_cast<std::uint64_t>(k + 1);
    const double give_up = k == 0 ? due + kPatience : due + 2.0 * kShare * kTeleopTick;
    bool commanded = false;
    do {  // the first packet goes out again until the other process is there
      other.send(number, slave.body().x, slave.contact(), estimated, slave.orientation());
      const double retry = k == 0 ? std::min(give_up, monotonic_seconds() + 0.1) : give_up;
      commanded = other.receive(number, retry, command) == number;
    } while (!commanded && monotonic_seconds() < give_up);
    require(commanded || k > 0, Exit::kFailure, "the controller does not answer at ",
            controller.peer, "; start it with the same key");
    const double now = monotonic_seconds();
    commanded ? times.controller.add(now - identified) : void(++times.controller_misses);
    if (k == 0) start = now;
    times.overruns += k > 0 && now > due + kTeleopTick;
    slave.integrate(command);
  }
  return times.to_json(ticks);
}

std::string live_text(const Json& times) {
  return "cycles      " + counts_text(times["states"]) + "\n" +  //
         "missed      " + times["identifier_misses"].dump() + " by dcnn-run, " +
         times["controller_misses"].dump() + " by the controller; " + times["overruns"].dump() +
         " overrun\n" + "clock       " + times_text(times["wake_up_jitter"]) + " late\n" +
         "dcnn-run    " + times_text(times["identifier_round_trip"]) + " for an answer\n" +
         "controller  " + times_text(times["controller_round_trip"]) + " for an answer\n";
}

TeleopTrace run_live_controller(const TeleopConfig& config, const Ends& sensor,
                                const PacketKey& key, std::uint64_t seed) {
  Exchange other(sensor, key);
  MasterSide master(config, seed);
  const auto ticks = static_cast<Index>(std::lround(config.duration_s / kTeleopTick));
  TeleopTrace trace = make_trace(ticks);
  SlaveTick slave;
  for (Index k = 0; k < ticks;) {
    const std::uint64_t number = other.receive(0, monotonic_seconds() + 3.0 * kPatience, slave.x,
                                               slave.contact, slave.estimated, slave.orientation);
    require(number > 0, Exit::kFailure, "nothing comes from the sensor at ", sensor.peer,
            "; start it with the same key");
    // Ticks whose packet was lost pass with what the last one said.
    for (; k < ticks && static_cast<std::uint64_t>(k) < number; ++k) {
      const Command command = master.control(slave.estimated);
      if (static_cast<std::uint64_t>(k) + 1 == number) other.send(number, command);
      store(k, config, slave, master, trace);
      master.integrate(static_cast<double>(k) * kTeleopTick);
    }
  }
  return trace;
}

}  // namespace dcnn
