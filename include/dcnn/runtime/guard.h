// SPDX-License-Identifier: Apache-2.0
// Between a network and a hand: every output finite, bounded and slew-limited, whatever comes in.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <limits>
#include <optional>

namespace dcnn {

/// Force [N] above torque [N·m].
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Where the output comes from (in order of trust).
enum class RunState : std::uint8_t {
  kWarmup,   ///< the windows are not full: the output stays where it is (zero at the start)
  kNetwork,  ///< measured force less the model's prediction
  kPhysics,  ///< the same with the fallback: the model's input or output cannot be trusted
  kHold,     ///< neither can be trusted for a moment: the last output
  kFade,     ///< and not soon enough again: to zero
  kFault,    ///< latched until rearm()
};
const char* name_of(RunState state);

/// Why the network is not followed.
enum class Reason : std::uint8_t {
  kNone,
  kWarmup,        ///< windows fill
  kMissing,       ///< no sample came in time
  kNotFinite,     ///< a number of the sample is not finite or impossible
  kClock,         ///< time repeats, runs backwards or runs at another rate
  kGap,           ///< time stood still too long: windows begin anew
  kEnvelope,      ///< motion unlike that of training
  kSingular,      ///< Euler angles near their singularity (feature set `pose`)
  kModel,         ///< the model's prediction is not finite
  kDisagreement,  ///< model and fallback contradict each other
  kLimit,         ///< what the model leaves is beyond the output limit
  kOverrun,       ///< the cycle before took longer than a sample
  kReturning,     ///< good again, but not yet for long enough
  kLatched,       ///< a fault waits for the operator
};
const char* name_of(Reason reason);

struct GuardLimits {
  int warmup_cycles = 51;
  int hold_cycles = 3;
  int fade_cycles = 100;         ///< then kFault
  int return_cycles = 25;        ///< good ones in a row before the network is trusted again
  double force_n = 50.0;         ///< per axis
  double torque_nm = 5.0;        ///< per axis
  double slew_n = 1.0;           ///< per axis and cycle
  double slew_nm = 0.1;          ///< per axis and cycle
  double disagreement_n = 10.0;  ///< between model and fallback
  double disagreement_nm = 1.0;
};

/// What one cycle brings, all in one frame. Numbers may be anything.
struct Cycle {
  Vector6d measured = Vector6d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::optional<Vector6d> network;  ///< the model's prediction of the tool's wrench
  std::optional<Vector6d> physics;  ///< the fallback's
  Reason distrust = Reason::kNone;  ///< why the network must not be followed in this cycle
};

/// Allocates nothing, throws nothing.
class Guard {
 public:
  explicit Guard(const GuardLimits& limits = {}) : limits_(limits) {}

  /// The external wrench for this cycle.
  const Vector6d& step(const Cycle& cycle) noexcept;
  RunState state() const { return state_; }
  /// kNone in kNetwork, else why not.
  Reason reason() const { return reason_; }
  /// The output is held back by the limit or the slew limit.
  bool limited() const { return limited_; }
  /// The operator's word that a fault is over: begins again with kWarmup, from the output held.
  void rearm() noexcept;

 private:
  Reason judge(const Cycle& cycle, bool measured, bool physics) const noexcept;
  RunState decide(bool network, bool physics) noexcept;
  void approach(const Vector6d& target) noexcept;

  GuardLimits limits_;
  RunState state_ = RunState::kWarmup;
  Reason reason_ = Reason::kWarmup;
  bool limited_ = false;
  int cycles_ = 0, bad_ = 0, good_ = 0;
  Vector6d output_ = Vector6d::Zero();
};

}  // namespace dcnn
