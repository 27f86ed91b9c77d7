// SPDX-License-Identifier: Apache-2.0
// Cycles of dcnn-run behind the packets: any numbers, clocks, silences, overruns and rearms. The
// force put out is finite, within its limit and its slew, in all of them.
#include <cmath>
#include <cstring>

#include "dcnn/runtime/open.h"
#include "fuzz/support.h"

using namespace dcnn;

namespace {

constexpr const char* kTool =
    R"({"tool": {"mass_kg": 0.7, "com_m": [0, 0, 0.1]}, "model": {"inertial": "none"}, "sample_rate_hz": 500,
        "derivative": {"kind": "sg_causal", "window_s": 0.01, "order": 2}})";

/// Bytes as numbers: a byte that says of which kind, and its bytes.
class Numbers {
 public:
  Numbers(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool ended() const { return size_ == 0; }
  std::uint8_t byte() {
    if (size_ == 0) return 0;
    --size_;
    return *data_++;
  }
  /// Any double, or one that a robot could send.
  double number() {
    const std::uint8_t kind = byte();
    if (kind < 250) return (kind - 125.0) / 125.0;
    std::uint64_t bits = 0;
    for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Simulator simulator = parse_simulator(Json::parse(kTool), "tool", Exit::kFailure);
  Numbers in(data, size);
  CompensatorOptions options;
  options.guard.warmup_cycles = 3;
  options.guard.fade_cycles = 5;
  const std::uint8_t choice = in.byte();
  options.average = 1 + choice % 16;
  options.contact_n = 1.0;
  if ((choice & 16) != 0) options.bias_seconds = 0.1;
  OnlineCompensator compensator(nullptr, &simulator, options, "fuzz");
  OnlineSample sample;
  Vector6d before = Vector6d::Zero();
  while (!in.ended()) {
    const std::uint8_t what = in.byte();
    if (what % 32 == 0) compensator.overrun();
    sample.rearm = (what & 64) != 0;
    sample.t = std::isfinite(sample.t) ? sample.t + 0.002 : 0.0;
    switch (what % 8) {
      case 1:
        sample.t = in.number();
        break;
      case 2:
        sample.position[what % 3] = in.number();
        break;
      case 3:
        for (double& part : sample.quaternion) part = in.number();
        break;
      case 4:
        sample.euler = Eigen::Vector3d(in.number(), in.number(), in.number());
        break;
      case 5:
        sample.wrench[what % 6] = 10.0 * in.number();
        break;
      case 6:
        sample.t += 0.002 * in.byte();
        break;
      default:
        break;
    }
    const OnlineResult& result = what % 8 == 7 ? compensator.miss() : compensator.step(sample);
    fuzz::demand(result.external.allFinite() && result.bias.allFinite() && std::isfinite(result.t),
                 "an output that is not finite");
    fuzz::demand(result.bias.cwiseAbs().maxCoeff() <= options.bias_limit_n,
                 "a bias beyond its limit");
    for (int i = 0; i < 6; ++i) {
      const double limit = i < 3 ? options.guard.force_n : options.guard.torque_nm;
      const double slew = i < 3 ? options.guard.slew_n : options.guard.slew_nm;
      fuzz::demand(std::abs(result.external[i]) <= limit, "an output beyond its limit");
      fuzz::demand(std::abs(result.external[i] - before[i]) <= slew * (1.0 + 1e-12),
                   "an output that moves faster than its slew");
    }
    before = result.external;
  }
  return 0;
}
