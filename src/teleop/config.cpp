// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "dcnn/core/options.h"
#include "dcnn/teleop/teleop.h"

namespace dcnn {
namespace {

constexpr double kLarge = 1e6;

Eigen::Matrix4d read_frame(Options& options, const std::string& key) {
  if (!options.has(key)) return Eigen::Matrix4d::Identity();
  const auto rows = options.get<std::vector<std::vector<double>>>(key);
  Eigen::Matrix4d T;
  if (rows.size() != 4) options.reject(key, "must be 4x4");
  for (std::size_t i = 0; i < 4; ++i) {
    if (rows[i].size() != 4) options.reject(key, "must be 4x4");
    for (std::size_t k = 0; k < 4; ++k) {
      T(static_cast<Index>(i), static_cast<Index>(k)) = rows[i][k];
    }
  }
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  const bool rigid = T.allFinite() && R.determinant() > 0.0 &&
                     (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
                     (T.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() == 0.0;
  if (!rigid) options.reject(key, "is no homogeneous transform of a rotation and a translation");
  return T;
}

void read_bodies(Options& all, TeleopConfig& c) {
  Options master = all.child("master");
  c.master_mass = master.number("mass_kg", c.master_mass, 0.01, 100.0);
  c.hand_stiffness = master.number("hand_stiffness", c.hand_stiffness, 1.0, kLarge);
  c.hand_damping = master.number("hand_damping", c.hand_damping, 0.0, kLarge);
  c.master_damping = master.number("damping", c.master_damping, 0.0, kLarge);
  master.finish();
  Options slave = all.child("slave");
  c.slave_mass = slave.number("mass_kg", c.slave_mass, 0.01, 1000.0);
  c.slave_stiffness = slave.number("stiffness", c.slave_stiffness, 1.0, kLarge);
  c.slave_damping_ratio = slave.number("damping_ratio", c.slave_damping_ratio, 0.0, 10.0);
  c.slave_friction = slave.number("friction_n", c.slave_friction, 0.0, 1000.0);
  c.friction_speed = slave.number("friction_speed", c.friction_speed, 1e-4, 1.0);
  slave.finish();
  Options wall = all.child("wall");
  c.wall_z = wall.number("z_m", c.wall_z, -1.0, 1.0);
  c.wall_stiffness = wall.number("stiffness", c.wall_stiffness, 0.0, kLarge);
  c.wall_damping = wall.number("damping", c.wall_damping, 0.0, kLarge);
  c.push_m = wall.number("push_m", c.push_m, 0.0, 1.0);
  wall.finish();
}

void read_link(Options& all, TeleopConfig& c) {
  Options link = all.child("link");
  c.delay_ticks = static_cast<Index>(std::lround(
      link.number("delay_s", static_cast<double>(c.delay_ticks) * 0.002, 0.0, 2.0) / 0.002));
  c.delay_jitter_ticks =
      static_cast<Index>(std::lround(link.number("jitter_s", 0.0, 0.0, 2.0) / 0.002));
  c.packet_loss = link.number("loss", c.packet_loss, 0.0, 0.99);
  c.passivity = link.get("passivity", c.passivity);
  link.finish();
  Options feedback = all.child("feedback");
  c.force_scale = feedback.number("scale", c.force_scale, 0.0, 10.0);
  c.force_limit = feedback.number("limit_n", c.force_limit, 0.0, 1000.0);
  c.force_lowpass_hz = feedback.number("lowpass_hz", c.force_lowpass_hz, 0.1, 250.0);
  c.force_dead_zone = feedback.number("dead_zone_n", c.force_dead_zone, 0.0, 1000.0);
  c.position_scale = feedback.number("position_scale", c.position_scale, 0.01, 10.0);
  feedback.finish();
}

Simulator paper_tool() {
  return parse_simulator(
      Json{
          {"tool", {{"mass_kg", 0.75}, {"com_m", {0.004, -0.006, 0.16}}}},
          {"sensor", {{"bias_n", {0.6, -0.4, 1.1}}, {"rotation_rpy", {-0.0262, 0.0349, -0.5236}}}}},
      "the default tool", Exit::kFailure);
}

}  // namespace

TeleopConfig parse_teleop(const Json& json, const std::string& where) {
  TeleopConfig c;
  Options all(json, where, Exit::kUsage);
  c.duration_s = all.number("duration_s", c.duration_s, 1.0, 3600.0);
  read_bodies(all, c);
  read_link(all, c);
  const Json tool = all.raw("tool");
  c.tool = tool.is_null() ? paper_tool() : parse_simulator(tool, where, Exit::kUsage);
  c.force_noise = all.number("force_noise_n", c.force_noise, 0.0, 100.0);
  c.orientation_amplitude = all.number("orientation_rad", c.orientation_amplitude, 0.0, 1.4);
  Options frames = all.child("frames");
  c.T_master_slave = read_frame(frames, "master_slave");
  c.T_base_tip = read_frame(frames, "base_tip");
  c.T_workspace_camera = read_frame(frames, "workspace_camera");
  frames.finish();
  all.finish();
  return c;
}

}  // namespace dcnn
