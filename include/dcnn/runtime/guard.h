// Between a network and a hand: every output finite, bounded and slew-limited, whatever comes in.
#pragma once

#include <Eigen/Dense>
#include <optional>

namespace dcnn {

/// Where the output comes from (in order of trust).
enum class RunState {
  kWarmup,   ///< the derivative window is not full: the output stays at zero
  kNetwork,  ///< measured force less the model's prediction
  kPhysics,  ///< the same with the fallback: the model's input or output cannot be trusted
  kHold,     ///< neither can be trusted for a moment: the last output
  kFade,     ///< and not soon enough again: to zero
  kFault,    ///< latched until rearm()
};
const char* name_of(RunState state);

struct GuardLimits {
  int warmup_cycles = 51;
  int hold_cycles = 3;
  int fade_cycles = 100;         ///< then kFault
  int return_cycles = 25;        ///< good ones in a row before the network is trusted again
  double force_n = 50.0;         ///< per axis
  double slew_n = 1.0;           ///< per axis and cycle
  double disagreement_n = 10.0;  ///< between model and fallback
};

/// What one cycle brings. Numbers may be anything.
struct Cycle {
  Eigen::Vector3d measured;
  std::optional<Eigen::Vector3d> network;  ///< the model's prediction of the tool's force
  std::optional<Eigen::Vector3d> physics;  ///< the fallback's
  bool in_envelope = true;                 ///< the input is like that of training
};

/// Allocates nothing.
class Guard {
 public:
  explicit Guard(const GuardLimits& limits = {}) : limits_(limits) {}

  /// The external force in S [N] for this cycle.
  const Eigen::Vector3d& step(const Cycle& cycle);
  RunState state() const { return state_; }
  /// The operator's word that a fault is over: begins again with kWarmup, from the output held.
  void rearm();

 private:
  RunState decide(bool network, bool physics);
  void approach(const Eigen::Vector3d& target);

  GuardLimits limits_;
  RunState state_ = RunState::kWarmup;
  int cycles_ = 0, bad_ = 0, good_ = 0;
  Eigen::Vector3d output_ = Eigen::Vector3d::Zero();
};

}  // namespace dcnn
