// SPDX-License-Identifier: Apache-2.0
// A drawn axis: its machine, the log that its drive keeps, and what is hidden in it.
#pragma once

#include "conceal/axis_world.h"

namespace dcnn::conceal {

/// How the log is kept.
struct AxisLogging {
  double hz = 500.0;
  double encoder = 0.0;  ///< count, or rms of noise where not `counts` [position unit]
  bool counts = true;
  double velocity_hz = 0.0;     ///< corner of the logged velocity's low-pass; 0: none is logged
  double jitter = 0.0;          ///< rms of the error of t, in rows
  double lost = 0.0;            ///< share of the rows that the log lacks
  int held = 1;                 ///< rows for which an effort is held
  double filter_s = 0.0;        ///< lag of the measured effort, which the simulated column has too
  double lowpass_hz = 0.0;      ///< declared in the description; 0: none
  std::string noise = "white";  ///< white, ar1, load or quantised
  double sigma = 1.0;           ///< rms of the effort's noise [unit]
  double keep = 0.0;            ///< of ar1, from one row to the next
  double digit = 0.0;           ///< step of a quantised reading [unit], 0.4 sigma or less
};

struct AxisRecording {
  std::string name, motion;
  bool holdout = false;
  Eigen::VectorXd t, q, velocity, measured, clean, simulated;  ///< velocity may be empty
  std::vector<bool> fresh;                                     ///< rows whose effort is new
};

struct AxisScenario {
  std::string id, group, name;
  AxisBody body;
  std::string form;    ///< of the simulator: simulated, base or constant
  double scale = 1.0;  ///< effort of one unit of the simulated column
  AxisLogging log;
  std::string motion;
  double resting = 0.0;
  std::vector<Hidden> hidden;
  std::vector<AxisRecording> recordings;
  double span = 0.0;  ///< end of the clock [s]
};

/// The parts of an id of axis_plan(); Error(kUsage) for another one.
struct AxisRequest {
  std::string group;
  double from = 0.0;  ///< times the noise
  std::vector<std::string> effects;
};
AxisRequest parse_axis_id(const std::string& id);

/// Sizes but for those that depend on the motion, which set_rigid() gives.
AxisBody draw_axis_body(const std::vector<std::string>& effects, Rng& rng);
/// Inertia, friction, spring and gravity such that the rigid effort has body.effort as rms.
/// `free`: terms that the simulator must leave out (viscous, stiffness).
void set_rigid(AxisBody& body, const std::string& form, const std::string& left_out,
               const std::vector<AxisPath>& fitted, Rng& rng);

/// Whether an effect can be told with this form of simulator, on this kind of motion.
bool can_be_told(const std::string& effect, const std::string& form, const std::string& motion,
                 double resting);

AxisLogging draw_axis_logging(const AxisBody& body, const std::string& form, Rng& rng);
/// Rows as the log holds them; `signal`: what the sensor shows before noise, at the path's rate.
void log_axis(const AxisScenario& s, const AxisPath& path, const Eigen::VectorXd& signal,
              AxisRecording& recording, Rng& rng);

/// Of an id of axis_plan(); the same arguments give the same bytes.
AxisScenario draw_axis_scenario(const std::string& id, std::uint64_t seed);
/// rms of what the true law leaves of the held-out effort, low-passed as the description says.
double axis_oracle(const AxisScenario& s);
Json axis_truth(const AxisScenario& s);

}  // namespace dcnn::conceal
