// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "dcnn/data/rotation.h"
#include "dcnn/runtime/serve.h"
#include "runtime/tally.h"

namespace dcnn {
namespace {

constexpr double kPatience = 1.0;  // s, for the loopback

/// Every row of a recording as a sample.
std::vector<OnlineSample> samples_of(const Recording& recording) {
  const Eigen::MatrixXd position = recording.block({"x", "y", "z"}), q = quaternions(recording);
  const Eigen::MatrixXd force = recording.block({"fx", "fy", "fz"});
  const bool torques = recording.has_all({"tx", "ty", "tz"});
  const Eigen::MatrixXd torque =
      torques ? recording.block({"tx", "ty", "tz"}) : Eigen::MatrixXd::Zero(recording.samples(), 3);
  std::vector<OnlineSample> samples(static_cast<std::size_t>(recording.samples()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto k = static_cast<Index>(i);
    samples[i].position = position.row(k);
    samples[i].quaternion = q.row(k);
    samples[i].wrench << force.row(k).transpose(), torque.row(k).transpose();
  }
  return samples;
}

/// Memory of this process that no file backs, bytes: pages of code that are met late are no growth.
std::uint64_t own_bytes() {
  std::uint64_t pages = 0, resident = 0, shared = 0;
  if (FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu %lu %lu", &pages, &resident, &shared) != 3) resident = shared = 0;
    std::fclose(file);
  }
  return (resident - shared) * 4096;
}

}  // namespace

Json rehearse(OnlineCompensator& compensator, const Recording& recording, std::uint64_t cycles) {
  const std::vector<OnlineSample> samples = samples_of(recording);
  require(samples.size() > 1, Exit::kData, recording.name, ": too short to rehearse with");
  const PacketKey key{};
  PacketGate gate(key, 1);
  auto [here, there] = UdpSocket::pair();
  std::array<std::uint8_t, kMostBytes> buffer;
  Tally tally;
  const double dt = compensator.dt();
  std::uint64_t alarms = 0, before = 0;
  bool outside = false;
  for (std::uint64_t k = 0; k < cycles; ++k) {
    if (k == cycles / 10) before = own_bytes();
    const std::uint64_t place = k % (2 * (samples.size() - 1));
    OnlineSample sample = samples[std::min(place, 2 * (samples.size() - 1) - place)];
    sample.t = static_cast<double>(k) * dt;
    PacketWriter packet({PacketKind::kSample, 1, k + 1, sample.t});
    write_sample(sample, packet);
    there.send(packet.seal(key));
    const double begin = thread_seconds();
    OnlineSample taken;
    const auto size = here.receive(buffer, monotonic_seconds() + kPatience);
    const Verdict verdict = gate.judge({buffer.data(), size.value_or(0)}, sample.t, taken);
    require(verdict == Verdict::kAccepted, Exit::kFailure,
            "a rehearsed packet was refused: ", name_of(verdict));
    const OnlineResult& result = compensator.step(taken);
    here.send(gate.answer(result, 0.0));
    tally.times.add(thread_seconds() - begin);
    there.receive(buffer, monotonic_seconds() + kPatience);
    tally.add(result);
    alarms += result.novelty > 1.0 && !outside;
    outside = result.novelty > 1.0;
  }
  Json json = tally.to_json();
  json["hours"] = static_cast<double>(cycles) * dt / 3600.0;
  json["envelope_alarms"] = alarms;
  json["memory_growth_bytes"] = static_cast<std::int64_t>(own_bytes() - before);
  return json;
}

}  // namespace dcnn
