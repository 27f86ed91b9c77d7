#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/data/rotation.h"
#include "dcnn/teleop/teleop.h"
#include "teleop/link.h"
#include "teleop/passivity.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kStep = 1e-3;  // s, integration
constexpr Index kStepsPerTick = 2;
constexpr double kControlStep = kStepsPerTick * kStep;
constexpr double kTurn = 2.0 * std::numbers::pi;

struct Body {
  Vector3d x = Vector3d::Zero(), v = Vector3d::Zero(), a = Vector3d::Zero();
  void step(const Vector3d& acceleration) {  // semi-implicit Euler
    a = acceleration;
    v += kStep * a;
    x += kStep * v;
  }
};

/// Orientation and its first two derivatives (rad): smooth sines.
struct Orientation {
  Vector3d angle, rate, acceleration;
  Orientation(const TeleopConfig& config, double t) : angle(config.orientation_center) {
    constexpr double kHz[3] = {0.05, 0.065, 0.08};
    for (int i = 0; i < 3; ++i) {
      const double w = kTurn * kHz[i], a = config.orientation_amplitude;
      angle[i] += a * std::sin(w * t);
      rate[i] = a * w * std::cos(w * t);
      acceleration[i] = -a * w * w * std::sin(w * t);
    }
  }
};

class Session {
 public:
  Session(const TeleopConfig& config, Variant& variant, const Eigen::Matrix3d& R_ES,
          std::uint64_t seed)
      : config_(config),
        variant_(variant),
        R_ES_(R_ES),
        rng_({seed, 17}),
        forward_(config.delay_ticks, config.delay_jitter_ticks, config.packet_loss, seed, 18),
        backward_(config.delay_ticks, config.delay_jitter_ticks, config.packet_loss, seed, 19),
        guard_(config.passivity) {
    damping_ =
        2.0 * config.slave_damping_ratio * std::sqrt(config.slave_stiffness * config.slave_mass);
    // First order, exact for a force held over a tick.
    smoothing_ = 1.0 - std::exp(-kTurn * config.force_lowpass_hz * kControlStep);
    hand_.v = intended_rate(0.0);
    master_.v = slave_.v = hand_.v;
  }

  TeleopTrace run() {
    const auto ticks = static_cast<Index>(std::lround(config_.duration_s / kControlStep));
    TeleopTrace trace;
    trace.t.resize(ticks);
    trace.energy.resize(ticks);
    for (auto* block : {&trace.intended, &trace.master, &trace.slave, &trace.contact,
                        &trace.estimated, &trace.felt, &trace.orientation}) {
      block->resize(ticks, 3);
    }
    for (Index k = 0; k < ticks; ++k) {
      control(static_cast<double>(k) * kControlStep);
      store(k, trace);
      for (Index s = 0; s < kStepsPerTick; ++s) {
        integrate((static_cast<double>(k * kStepsPerTick + s)) * kStep);
      }
    }
    trace.dissipated = guard_.dissipated();
    return trace;
  }

 private:
  Vector3d intended_rate(double t) const {
    constexpr double h = 1e-5;
    return (intended_motion(t + h, config_.push_m) - intended_motion(t - h, config_.push_m)) /
           (2.0 * h);
  }

  Vector3d wall_force() const {
    const double depth = config_.wall_z - slave_.x.z();
    if (depth <= 0.0) return Vector3d::Zero();
    return {0.0, 0.0,
            std::max(0.0, config_.wall_stiffness * depth - config_.wall_damping * slave_.v.z())};
  }

  /// What the sensor reads in S: the tool's own force and the contact.
  Vector3d measured(double t, const Orientation& o) {
    Trajectory instant;
    instant.dt = kControlStep;
    instant.t = Eigen::VectorXd::Constant(1, t);
    instant.position = slave_.x.transpose();
    instant.velocity = slave_.v.transpose();
    instant.acceleration = slave_.a.transpose();
    instant.euler = o.angle.transpose();
    instant.euler_rate = o.rate.transpose();
    instant.euler_acceleration = o.acceleration.transpose();
    const Motion motion = motion_of(instant, config_.tool.model);
    Vector3d force = simulate(config_.tool, motion).force.row(0).transpose();
    force += motion.R_BS[0].transpose() * contact_;
    for (int i = 0; i < 3; ++i) force[i] += config_.force_noise * rng_.normal();
    return force;
  }

  /// The external force in B as this variant knows it.
  Vector3d estimate(double t, const Orientation& o) {
    if (variant_.kind == Variant::Kind::kIdeal) return contact_;
    if (variant_.kind == Variant::Kind::kNone) return Vector3d::Zero();
    Vector3d force = measured(t, o);
    if (variant_.compensator) force -= variant_.compensator->push(slave_.x, o.angle);
    return rotation_from_euler(o.angle) * R_ES_ * force;
  }

  void control(double t) {
    contact_ = wall_force();
    const Orientation o(config_, t);
    orientation_ = o.angle;
    estimated_ = estimate(t, o);
    filtered_ += smoothing_ * (estimated_ - filtered_);
    Vector6d sent = Vector6d::Zero();
    sent.head<3>() = filtered_;
    const Vector3d arrived = backward_.pass(sent).head<3>();
    Vector3d force = config_.force_scale * arrived;
    if (arrived.norm() < config_.force_dead_zone) force.setZero();
    if (force.norm() > config_.force_limit) force *= config_.force_limit / force.norm();
    felt_ = guard_.act(force, master_.v, kControlStep);
    if (felt_.norm() > config_.force_limit) felt_ *= config_.force_limit / felt_.norm();
    sent << master_.x, master_.v;
    command_ = config_.position_scale * forward_.pass(sent);
  }

  void integrate(double t) {
    const auto& c = config_;
    hand_.x = intended_motion(t, c.push_m);
    hand_.v = intended_rate(t);
    const Vector3d spring = c.slave_stiffness * (command_.head<3>() - slave_.x) +
                            damping_ * (command_.tail<3>() - slave_.v);
    const Vector3d friction =
        c.slave_friction * (slave_.v / c.friction_speed).array().tanh().matrix();
    slave_.step((spring + wall_force() - friction) / c.slave_mass);
    master_.step((c.hand_stiffness * (hand_.x - master_.x) +
                  c.hand_damping * (hand_.v - master_.v) - c.master_damping * master_.v + felt_) /
                 c.master_mass);
  }

  void store(Index k, TeleopTrace& trace) const {
    const double t = static_cast<double>(k) * kControlStep;
    trace.t[k] = t;
    trace.intended.row(k) = intended_motion(t, config_.push_m);
    trace.master.row(k) = master_.x;
    trace.slave.row(k) = slave_.x;
    trace.contact.row(k) = contact_;
    trace.estimated.row(k) = estimated_;
    trace.felt.row(k) = felt_;
    trace.orientation.row(k) = orientation_;
    trace.energy[k] = guard_.energy();
  }

  const TeleopConfig& config_;
  Variant& variant_;
  Eigen::Matrix3d R_ES_;
  Rng rng_;
  Link forward_, backward_;
  PassivityGuard guard_;
  double damping_ = 0.0, smoothing_ = 0.0;
  Body hand_, master_, slave_;
  Vector3d contact_ = Vector3d::Zero(), estimated_ = Vector3d::Zero(), filtered_ = Vector3d::Zero(),
           felt_ = Vector3d::Zero(), orientation_;
  Vector6d command_ = Vector6d::Zero();
};

}  // namespace

TeleopTrace run_teleop(const TeleopConfig& config, Variant& variant, const Eigen::Matrix3d& R_ES,
                       std::uint64_t seed) {
  return Session(config, variant, R_ES, seed).run();
}

}  // namespace dcnn
