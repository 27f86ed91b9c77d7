// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/compensator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dcnn/data/rotation.h"
#include "runtime/checks.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kTooFast = 0.6;  // of the sample time between two samples
constexpr int kSteady = 25;       // samples in a row, until another clock is followed
constexpr double kQuiet = 0.5;    // s without contact before the bias is tracked again

Matrix3d rotation_of(const OnlineSample& sample) {
  if (sample.euler) return rotation_from_euler(*sample.euler);
  return rotation_from_quaternion(sample.quaternion.normalized());
}

/// Euler angles count where a sample has them: its quaternion may then be anything.
Vector4d attitude(const OnlineSample& sample) {
  return sample.euler ? quaternion_from_euler(*sample.euler) : sample.quaternion;
}

Vector6d turned(const Matrix3d& R, const Vector6d& wrench) {
  Vector6d out;
  out << R * wrench.head<3>(), R * wrench.tail<3>();
  return out;
}

}  // namespace

OnlineCompensator::OnlineCompensator(const Identifier* network, const Simulator* physics,
                                     const CompensatorOptions& options, const std::string& where)
    : options_(options) {
  require(options.average >= 1 && options.average <= static_cast<int>(kReadings), Exit::kUsage,
          "the average must be over 1 to ", kReadings, " readings");
  DerivativeSpec derivative = causal_derivative();
  if (network) {
    load(*network, where);
    derivative = network->layout.spec.derivative;
    dt_ = network->layout.dt;
  } else {
    require(physics, Exit::kUsage, "neither a model nor a simulator is given");
    dt_ = 1.0 / physics->model.sample_rate_hz;
    if (physics->derivative && is_causal(*physics->derivative)) derivative = *physics->derivative;
    if (physics->online_derivative) derivative = *physics->online_derivative;
  }
  if (physics) {
    physics_ = std::make_unique<StreamingSimulator>(*physics, derivative, dt_, where, Exit::kData);
    require(!network || !torque_ || physics_->has_torque(), Exit::kData, where,
            ": the model predicts torques and the fallback does not; give its tool an inertia");
    torque_ = physics_->has_torque() && (!network || torque_);
  }
  if (options.envelope) envelope_ = *options.envelope;
  if (options.contact_n) contact_n_ = options.contact_n;
  require(options.bias_seconds <= 0.0 || contact_n_, Exit::kUsage,
          "the bias can be tracked only where contact is detected; give the threshold");
  window_ = static_cast<std::size_t>(contact_window(dt_));
  options_.guard.warmup_cycles = std::max(options.guard.warmup_cycles, derivative.window(dt_));
  guard_ = Guard(options_.guard);
  start_anew();
  settling_ = 0;  // the guard's own warm-up covers the beginning
}

OnlineCompensator::OnlineCompensator(OnlineCompensator&&) noexcept = default;
OnlineCompensator::~OnlineCompensator() = default;

void OnlineCompensator::load(const Identifier& identifier, const std::string& where) {
  require_online(identifier, where);
  places_ = wrench_places(identifier.targets, where);
  torque_ = places_.size() == 6;
  euler_features_ = identifier.layout.spec.set == FeatureSpec::Set::kPose;
  features_ = std::make_unique<StreamingFeatures>(identifier.layout);
  predictor_ = checked_predictor(identifier, where);
  if (identifier.base) {
    base_ =
        std::make_unique<StreamingSimulator>(*identifier.base, identifier.layout.spec.derivative,
                                             identifier.layout.dt, where, Exit::kModel);
  }
  if (identifier.online) {
    envelope_ = identifier.online->envelope;
    contact_n_ = identifier.online->contact_n;
  }
}

void OnlineCompensator::start_anew() noexcept {
  if (features_) features_->reset();
  if (predictor_) predictor_->reset();
  if (base_) base_->reset();
  if (physics_) physics_->reset();
  readings_.fill(Vector6d::Zero());
  forces_.fill(Vector3d::Zero());
  reading_ = readings_held_ = force_ = 0;
  settling_ = options_.guard.warmup_cycles;
}

/// What the sample's time stamp means; kNone and kGap let it in.
Reason OnlineCompensator::tell_time(const OnlineSample& sample) noexcept {
  if (!started_) {
    started_ = true;
    return Reason::kNone;
  }
  const double step = sample.t - last_.t;
  if (!(step > kTooFast * dt_)) {
    const double other = (sample.t - std::exchange(other_t_, sample.t)) / dt_;
    other_clock_ = other > kTooFast && other < 2.0 - kTooFast ? other_clock_ + 1 : 0;
    if (other_clock_ < kSteady) return Reason::kClock;
    start_anew();
    return Reason::kGap;
  }
  other_clock_ = 0;
  if (step > (options_.longest_bridge + 1.5) * dt_) {
    start_anew();
    return Reason::kGap;
  }
  bridge(sample, std::llround(step / dt_));
  return Reason::kNone;
}

/// Straight lines through samples that are missing between the last one and this one.
void OnlineCompensator::bridge(const OnlineSample& sample, Index steps) noexcept {
  if (steps < 2) return;  // nothing is missing, as in nearly every cycle
  const Vector4d from = attitude(last_);
  Vector4d to = attitude(sample);
  if (to.dot(from) < 0.0) to = -to;
  for (Index k = 1; k < steps; ++k) {
    const double u = static_cast<double>(k) / static_cast<double>(steps);
    std::optional<Vector3d> euler;
    if (sample.euler && last_.euler) {
      Vector3d way = *sample.euler - *last_.euler;
      for (double& angle : way) angle = nearest_turn(angle, 0.0);
      euler = *last_.euler + u * way;
    }
    feed(last_.position + u * (sample.position - last_.position), from + u * (to - from), euler);
  }
}

void OnlineCompensator::feed(const Vector3d& position, const Vector4d& quaternion,
                             const std::optional<Vector3d>& euler) noexcept {
  const auto push = [&](auto& stream) -> decltype(auto) {
    return euler ? stream.push(position, *euler) : stream.push(position, quaternion);
  };
  if (predictor_) {
    x_ = &push(*features_);
    const Eigen::VectorXd& y = predictor_->push(*x_);
    predicted_.setZero();
    for (std::size_t j = 0; j < places_.size(); ++j) predicted_[places_[j]] = y[Index(j)];
    if (base_) {
      const InstantWrench& part = push(*base_);
      predicted_.head<3>() += part.force;
      if (torque_) predicted_.tail<3>() += part.torque;
    }
  }
  if (physics_) {
    const InstantWrench& all = push(*physics_);
    simulated_ << all.force, all.torque;
  }
  if (settling_ > 0) --settling_;
}

Vector6d OnlineCompensator::averaged(const Vector6d& wrench) noexcept {
  const auto wanted = static_cast<std::size_t>(options_.average);
  readings_[reading_] = wrench;
  readings_held_ = std::min(readings_held_ + 1, wanted);
  Vector6d sum = Vector6d::Zero();
  double weights = 0.0;
  for (std::size_t age = 0; age < readings_held_; ++age) {
    const double weight = static_cast<double>(wanted - age);
    sum += weight * readings_[(reading_ + kReadings - age) % kReadings];
    weights += weight;
  }
  reading_ = (reading_ + 1) % kReadings;
  return sum / weights;
}

/// Whether the newest features are such that the network may be believed.
Reason OnlineCompensator::distrust() noexcept {
  if (!predictor_) return Reason::kNone;
  if (has_envelope()) {
    const double score = envelope_.score(*x_);
    result_.novelty = std::isfinite(score) ? score : std::numeric_limits<double>::max();
  }
  if (overrun_) return Reason::kOverrun;
  if (settling_ > 0) return Reason::kGap;
  return result_.novelty > 1.0 ? Reason::kEnvelope : Reason::kNone;
}

void OnlineCompensator::watch_contact(const Vector3d& external) noexcept {
  if (!contact_n_) return;
  forces_[force_] = external;
  force_ = (force_ + 1) % window_;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < window_; ++k) sum += forces_[k];
  const double level = sum.norm() / static_cast<double>(window_);
  if (level > *contact_n_) result_.contact = true;
  if (level < 0.5 * *contact_n_) result_.contact = false;
  quiet_ = result_.contact ? 0 : quiet_ + 1;
}

/// First-order tracking of what is left while nothing touches.
void OnlineCompensator::track_bias(const Vector3d& external_S) noexcept {
  if (options_.bias_seconds <= 0.0 || static_cast<double>(quiet_) * dt_ < kQuiet) return;
  const double share = std::min(1.0, dt_ / options_.bias_seconds);
  const double limit = options_.bias_limit_n;
  for (int i = 0; i < 3; ++i) {
    result_.bias[i] = std::clamp(result_.bias[i] + share * external_S[i], -limit, limit);
  }
}

const OnlineResult& OnlineCompensator::publish(const Cycle& cycle) noexcept {
  result_.external = guard_.step(cycle);
  result_.state = guard_.state();
  result_.reason = guard_.reason();
  result_.limited = guard_.limited();
  return result_;
}

const OnlineResult& OnlineCompensator::miss() noexcept {
  Cycle cycle;
  cycle.distrust = Reason::kMissing;
  return publish(cycle);
}

const OnlineResult& OnlineCompensator::step(const OnlineSample& sample) noexcept {
  if (sample.rearm && !rearm_before_ && guard_.state() == RunState::kFault) {
    guard_.rearm();
    start_anew();
    settling_ = 0;
    started_ = false;
    result_.contact = false;
  }
  rearm_before_ = sample.rearm;
  if (std::isfinite(sample.t)) result_.t = sample.t;
  Cycle cycle;
  cycle.distrust = is_possible(sample) ? tell_time(sample) : Reason::kNotFinite;
  if (cycle.distrust == Reason::kNotFinite || cycle.distrust == Reason::kClock) {
    return publish(cycle);
  }
  feed(sample.position, sample.quaternion, sample.euler);
  last_ = sample;
  cycle.distrust = distrust();
  const Matrix3d R_BE = rotation_of(sample);
  if (cycle.distrust == Reason::kNone && euler_features_ && is_singular(R_BE)) {
    cycle.distrust = Reason::kSingular;
  }
  overrun_ = false;

  Vector6d measured = averaged(sample.wrench);
  measured.head<3>() -= result_.bias;
  if (!torque_) measured.tail<3>().setZero();
  const Matrix3d R_BS = R_BE * options_.R_ES;
  cycle.measured = turned(R_BS, measured);
  if (predictor_) cycle.network = turned(R_BS, predicted_);
  if (physics_) cycle.physics = turned(R_BS, simulated_);
  if (!predictor_) cycle.distrust = Reason::kModel;
  publish(cycle);

  const bool network = result_.state == RunState::kNetwork;
  result_.tool = network || !physics_ ? predicted_ : simulated_;
  if (network || result_.state == RunState::kPhysics) {
    const Vector6d& tool = network ? predicted_ : simulated_;
    const Vector3d external = measured.head<3>() - tool.head<3>();
    watch_contact(external);
    track_bias(external);
  }
  return result_;
}

}  // namespace dcnn
