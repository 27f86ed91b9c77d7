// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/scenario.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "dcnn/core/blocking.h"
#include "dcnn/core/options.h"
#include "dcnn/data/rotation.h"
#include "dcnn/physics/simulator.h"
#include "dcnn/physics/trajectory.h"

namespace dcnn {
namespace {

constexpr double kMostNoise = 1e6;  // bound of noise levels: any unit, any real sensor
constexpr Index kMaxSamples = 20'000'000;

/// What a random stream is for; the third number of its key.
enum Purpose : std::uint64_t { kTrajectory, kPoseNoise, kSensorNoise };

/// What all recordings of a configuration share.
struct Setup {
  std::uint64_t seed = 1;
  double dt = 0.002;
  Simulator nominal, actual;
  bool as_quaternion = false;
  double position_noise = 0.0, angle_noise = 0.0;  ///< m, rad
  SensorNoise sensor_noise;
};

std::uint64_t read_seed(Options& options) {
  const Json seed = options.raw("seed");
  if (seed.is_null()) return 1;
  if (!seed.is_number_unsigned() && !(seed.is_number_integer() && seed.get<std::int64_t>() >= 0))
    options.reject("seed", "must be a whole number of at least 0");
  return seed.get<std::uint64_t>();
}

Setup read_setup(Options& options, const std::string& where,
                 std::optional<std::uint64_t> seed_override) {
  Setup setup;
  setup.seed = read_seed(options);
  if (seed_override) setup.seed = *seed_override;
  setup.nominal = parse_simulator(options.raw("simulator"), where + ": simulator", Exit::kUsage);
  const double rate =
      options.number("sample_rate_hz", setup.nominal.model.sample_rate_hz, 1e-3, 1e6);
  setup.dt = 1.0 / rate;
  setup.nominal.model.sample_rate_hz = rate;
  setup.as_quaternion =
      options.choice("orientation", "euler", {"euler", "quaternion"}) == "quaternion";
  Options pose = options.child("pose_noise");
  setup.position_noise = pose.number("m", 0.0, 0.0, kMostNoise);
  setup.angle_noise = pose.number("rad", 0.0, 0.0, std::numbers::pi);
  pose.finish();
  Options force = options.child("force_noise");
  setup.sensor_noise = {force.number("n", 0.0, 0.0, kMostNoise),
                        force.number("nm", 0.0, 0.0, kMostNoise),
                        force.number("ar", 0.0, -0.999999, 0.999999)};
  force.finish();
  setup.actual = setup.nominal;
  for (auto& effect : parse_effects(options.raw("hidden"), where + ": hidden", Exit::kUsage)) {
    setup.actual.effects.push_back(std::move(effect));
  }
  return setup;
}

Eigen::MatrixXd noise_of(Index rows, double deviation, Rng& rng) {
  Eigen::MatrixXd noise(rows, 3);
  for (Index k = 0; k < rows; ++k) {
    for (Index i = 0; i < 3; ++i) noise(k, i) = deviation * rng.normal();
  }
  return noise;
}

void set_block(Recording& recording, const std::vector<std::string>& names,
               const Eigen::MatrixXd& values) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    recording.set(names[i], values.col(static_cast<Index>(i)));
  }
}

/// (T,4) w,x,y,z with w >= 0, or (T,3) wrapped angles as a KUKA logs them.
void set_orientation(Recording& recording, const Eigen::MatrixXd& euler, bool as_quaternion) {
  Eigen::MatrixXd out(euler.rows(), as_quaternion ? 4 : 3);
  for (Index k = 0; k < euler.rows(); ++k) {
    const Eigen::Matrix3d R = rotation_from_euler(euler.row(k).transpose());
    if (!as_quaternion) {
      out.row(k) = euler_from_rotation(R).transpose();
      continue;
    }
    const Eigen::Quaterniond q(R);
    out.row(k) = std::copysign(1.0, q.w()) * Eigen::RowVector4d(q.w(), q.x(), q.y(), q.z());
  }
  const std::vector<std::string> names{"qw", "qx", "qy", "qz"}, angles{"alpha", "beta", "gamma"};
  set_block(recording, as_quaternion ? names : angles, out);
}

/// Time and pose of a trajectory, with white noise on the pose where `rng` is given.
Recording log_pose(const Setup& setup, const Trajectory& trajectory, const std::string& name,
                   Rng* rng) {
  const Index samples = trajectory.t.size();
  Recording recording;
  recording.name = name + ".csv";
  recording.dt = trajectory.dt;
  recording.segments = {{0, samples}};
  recording.table.values.resize(samples, 0);
  Eigen::MatrixXd position = trajectory.position, euler = trajectory.euler;
  if (rng) {
    position += noise_of(samples, setup.position_noise, *rng);
    euler += noise_of(samples, setup.angle_noise, *rng);
  }
  if (!trajectory.is_static()) {
    recording.set("t", trajectory.t);
    set_block(recording, {"x", "y", "z"}, position);
  }
  set_orientation(recording, euler, setup.as_quaternion);
  return recording;
}

/// The exact motion, its angles on the branch that a reader of the log will be on.
Motion motion_on_branch(const Trajectory& trajectory, const Recording& log,
                        const ToolModel& model) {
  Motion motion = motion_of(trajectory, model);
  motion.recording = log.name;
  const Eigen::RowVector3d turns =
      (continuous_euler(log).row(0) - motion.euler.row(0)) / (2.0 * std::numbers::pi);
  motion.euler.rowwise() += 2.0 * std::numbers::pi * turns.array().round().matrix();
  return motion;
}

void set_rates(Recording& recording, const Motion& motion) {
  Eigen::MatrixXd v_S = motion.v_B, a_S = motion.a_B;
  for (Index k = 0; k < motion.samples(); ++k) {
    v_S.row(k) *= motion.R_BS[static_cast<std::size_t>(k)];
    a_S.row(k) *= motion.R_BS[static_cast<std::size_t>(k)];
  }
  set_block(recording, {"vx", "vy", "vz"}, v_S);
  set_block(recording, {"wx", "wy", "wz"}, motion.w_S);
  set_block(recording, {"ax", "ay", "az"}, a_S);
  set_block(recording, {"dwx", "dwy", "dwz"}, motion.dw_S);
}

ToolModel true_tool(const Simulator& simulator) {
  ToolModel model = simulator.model;
  for (const auto& effect : simulator.effects) {
    if (find_effect(effect.effect)->stage == Stage::kTool) change_model(effect, model);
  }
  return model;
}

SimulatedRecording simulate_one(const Setup& setup, std::size_t index, const std::string& name,
                                const Sampling& sampling, const Options& trajectory_options) {
  const auto stream = [&](Purpose purpose) { return Rng({setup.seed, index, purpose}); };
  Rng shape = stream(kTrajectory), shake = stream(kPoseNoise), hiss = stream(kSensorNoise);
  const Trajectory trajectory = make_trajectory(trajectory_options, sampling, shape);
  SimulatedRecording out{name, log_pose(setup, trajectory, name, &shake),
                         log_pose(setup, trajectory, name, nullptr)};
  const Motion motion = motion_on_branch(trajectory, out.noisy, setup.nominal.model);
  set_wrench(simulate(setup.actual, motion, &setup.sensor_noise, &hiss), "", out.noisy);
  set_wrench(simulate(setup.actual, motion), "", out.clean);
  ToolModel tool = true_tool(setup.actual);
  tool.bias.setZero();
  tool.bias_torque.setZero();
  set_wrench(rigid_wrench(tool, motion), "_tool", out.clean);
  if (!trajectory.is_static()) set_rates(out.clean, motion);
  return out;
}

std::string read_name(Options& entry, const std::vector<SimulatedRecording>& before) {
  const auto name = entry.get<std::string>("name");
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.';
  });
  if (name.empty() || name.front() == '.' || !plain) {
    entry.reject("name", "must be letters, digits, _ - . only, not '", name, "'");
  }
  for (const auto& other : before) {
    if (other.name == name || other.name + "_clean" == name || name + "_clean" == other.name) {
      entry.reject("name", "'", name, "' would overwrite the files of '", other.name, "'");
    }
  }
  return name;
}

Sampling read_sampling(Options& entry, double dt) {
  Sampling sampling;
  sampling.samples = entry.get<Index>("samples");
  if (sampling.samples < 1 || sampling.samples > kMaxSamples) {
    entry.reject("samples", "must be between 1 and ", kMaxSamples, ", not ", sampling.samples);
  }
  sampling.dt = dt;
  sampling.t0 = entry.number("t0_s", 0.0, -kMostNoise, kMostNoise);
  return sampling;
}

Json truth_of(const Setup& setup, const Json& recordings) {
  return {{"seed", setup.seed},
          {"simulator", to_json(true_tool(setup.actual))},
          {"effects", to_json(setup.actual.effects)},
          {"pose_noise", {{"m", setup.position_noise}, {"rad", setup.angle_noise}}},
          {"force_noise",
           {{"n", setup.sensor_noise.force},
            {"nm", setup.sensor_noise.torque},
            {"ar", setup.sensor_noise.ar}}},
          {"recordings", recordings}};
}

}  // namespace

Scenario simulate_config(const Json& config, const std::string& where,
                         std::optional<std::uint64_t> seed_override) {
  fix_blocking();
  Options options(config, where, Exit::kUsage);
  const Setup setup = read_setup(options, where, seed_override);
  const Json list = options.raw("recordings");
  options.finish();
  require(list.is_array() && !list.empty(), Exit::kUsage, where,
          ": recordings must be a list of at least one {name, samples, trajectory}");
  Scenario scenario;
  for (std::size_t k = 0; k < list.size(); ++k) {
    Options entry(list[k], where + ": recording " + std::to_string(k), Exit::kUsage);
    const std::string name = read_name(entry, scenario.recordings);
    const Sampling sampling = read_sampling(entry, setup.dt);
    const Options trajectory = entry.child("trajectory");
    entry.finish();
    scenario.recordings.push_back(simulate_one(setup, k, name, sampling, trajectory));
  }
  scenario.simulator = to_json(setup.nominal);
  scenario.truth = truth_of(setup, list);
  return scenario;
}

}  // namespace dcnn
