// SPDX-License-Identifier: Apache-2.0
// The demonstration as separate processes over UDP, in real time (paper, IV-A): the slave's side
// with its sensor, the identifier (dcnn-run), and the controller on the master's side.
#pragma once

#include "dcnn/runtime/udp.h"
#include "dcnn/teleop/teleop.h"

namespace dcnn {

/// Own address and the other's, for a conversation of two.
struct Ends {
  std::string listen, peer;
};

/// The slave's side: paces the 500 Hz clock, asks the identifier and the controller in every tick,
/// goes on with the last answer where one is late. Jitter of its wake-ups, round trips and deadline
/// misses as JSON. Error(kFailure) where one of the others is not there.
Json run_live_sensor(const TeleopConfig& config, const Ends& identifier, const Ends& controller,
                     const PacketKey& key, std::uint64_t seed);

/// What run_live_sensor() reports, in words.
std::string live_text(const Json& times);

/// The master's side: answers every packet of the sensor with a command; ends after the configured
/// duration, or with Error(kFailure) when nothing comes for 10 s.
TeleopTrace run_live_controller(const TeleopConfig& config, const Ends& sensor,
                                const PacketKey& key, std::uint64_t seed);

}  // namespace dcnn
