// SPDX-License-Identifier: Apache-2.0
#include "teleop/sides.h"

namespace dcnn {

using Eigen::Vector3d;

Vector3d intended_rate(const TeleopConfig& config, double t) {
  constexpr double h = 1e-5;
  return (intended_motion(t + h, config.push_m) - intended_motion(t - h, config.push_m)) /
         (2.0 * h);
}

SlaveSide::SlaveSide(const TeleopConfig& config, std::uint64_t seed)
    : config_(config),
      rng_({seed, 17}),
      damping_(2.0 * config.slave_damping_ratio *
               std::sqrt(config.slave_stiffness * config.slave_mass)),
      turn_(config, 0.0) {
  slave_.v = intended_rate(config, 0.0);
}

Vector3d SlaveSide::wall_force() const {
  const double depth = config_.wall_z - slave_.x.z();
  if (depth <= 0.0) return Vector3d::Zero();
  return {0.0, 0.0,
          std::max(0.0, config_.wall_stiffness * depth - config_.wall_damping * slave_.v.z())};
}

void SlaveSide::begin(double t) {
  t_ = t;
  contact_ = wall_force();
  turn_ = SlaveTurn(config_, t);
}

Vector3d SlaveSide::measured() {
  Trajectory instant;
  instant.dt = kTeleopTick;
  instant.t = Eigen::VectorXd::Constant(1, t_);
  instant.position = slave_.x.transpose();
  instant.velocity = slave_.v.transpose();
  instant.acceleration = slave_.a.transpose();
  instant.euler = turn_.angle.transpose();
  instant.euler_rate = turn_.rate.transpose();
  instant.euler_acceleration = turn_.acceleration.transpose();
  const Motion motion = motion_of(instant, config_.tool.model);
  Vector3d force = simulate(config_.tool, motion).force.row(0).transpose();
  force += motion.R_BS[0].transpose() * contact_;
  for (int i = 0; i < 3; ++i) force[i] += config_.force_noise * rng_.normal();
  return force;
}

void SlaveSide::integrate(const Command& command) {
  for (Index s = 0; s < kStepsPerTick; ++s) {
    const Vector3d spring = config_.slave_stiffness * (command.head<3>() - slave_.x) +
                            damping_ * (command.tail<3>() - slave_.v);
    const Vector3d friction =
        config_.slave_friction * (slave_.v / config_.friction_speed).array().tanh().matrix();
    slave_.step((spring + wall_force() - friction) / config_.slave_mass);
  }
}

MasterSide::MasterSide(const TeleopConfig& config, std::uint64_t seed)
    : config_(config),
      forward_(config.delay_ticks, config.delay_jitter_ticks, config.packet_loss, seed, 18),
      backward_(config.delay_ticks, config.delay_jitter_ticks, config.packet_loss, seed, 19),
      guard_(config.passivity),
      // First order, exact for a force held over a tick.
      smoothing_(1.0 - std::exp(-2.0 * std::numbers::pi * config.force_lowpass_hz * kTeleopTick)) {
  hand_.v = intended_rate(config, 0.0);
  master_.v = hand_.v;
}

Command MasterSide::control(const Vector3d& estimated) {
  filtered_ += smoothing_ * (estimated - filtered_);
  Command sent = Command::Zero();
  sent.head<3>() = filtered_;
  const Vector3d arrived = backward_.pass(sent).head<3>();
  Vector3d force = config_.force_scale * arrived;
  if (arrived.norm() < config_.force_dead_zone) force.setZero();
  if (force.norm() > config_.force_limit) force *= config_.force_limit / force.norm();
  felt_ = guard_.act(force, master_.v, kTeleopTick);
  if (felt_.norm() > config_.force_limit) felt_ *= config_.force_limit / felt_.norm();
  sent << master_.x, master_.v;
  return config_.position_scale * forward_.pass(sent);
}

void MasterSide::integrate(double t) {
  for (Index s = 0; s < kStepsPerTick; ++s) {
    const double now = t + static_cast<double>(s) * kTeleopStep;
    hand_.x = intended_motion(now, config_.push_m);
    hand_.v = intended_rate(config_, now);
    master_.step((config_.hand_stiffness * (hand_.x - master_.x) +
                  config_.hand_damping * (hand_.v - master_.v) -
                  config_.master_damping * master_.v + felt_) /
                 config_.master_mass);
  }
}

TeleopTrace make_trace(Index ticks) {
  TeleopTrace trace;
  trace.t.resize(ticks);
  trace.energy.resize(ticks);
  for (auto* block : {&trace.intended, &trace.master, &trace.slave, &trace.contact,
                      &trace.estimated, &trace.felt, &trace.orientation}) {
    block->resize(ticks, 3);
  }
  return trace;
}

void store(Index k, const TeleopConfig& config, const SlaveTick& slave, const MasterSide& master,
           TeleopTrace& trace) {
  const double t = static_cast<double>(k) * kTeleopTick;
  trace.t[k] = t;
  trace.intended.row(k) = intended_motion(t, config.push_m);
  trace.master.row(k) = master.body().x;
  trace.slave.row(k) = slave.x;
  trace.contact.row(k) = slave.contact;
  trace.estimated.row(k) = slave.estimated;
  trace.felt.row(k) = master.felt();
  trace.orientation.row(k) = slave.orientation;
  trace.energy[k] = master.guard().energy();
  trace.dissipated = master.guard().dissipated();
}

}  // namespace dcnn
