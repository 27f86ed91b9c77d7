// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/streaming_simulator.h"

#include <cmath>

#include "data/feature_blocks.h"
#include "dcnn/data/rotation.h"
#include "physics/rigid.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

FeatureLayout layout_for(const ToolModel& model, const DerivativeSpec& derivative, double dt) {
  FeatureLayout layout;
  layout.spec.set = FeatureSpec::Set::kBody;
  layout.spec.sensor_rotation_rpy = model.sensor_rotation_rpy;
  layout.spec.derivative = derivative;
  layout.dt = dt;
  for (const Block& block : feature_blocks(layout.spec, System())) {
    layout.names.insert(layout.names.end(), block.names.begin(), block.names.end());
    layout.units.insert(layout.units.end(), block.names.size(), block.unit);
  }
  return layout;
}

}  // namespace

bool runs_online(const EffectSpec& effect) {
  const EffectKind* kind = find_effect(effect.effect);
  return kind && !effect.interval_s && effect.recording.empty() && (kind->change || kind->stream) &&
         !effect.parameters.contains("driven_by") && (!kind->online || kind->online(effect));
}

Simulator online_part(const Simulator& simulator, std::vector<std::string>& left_out) {
  Simulator part = simulator;
  part.effects.clear();
  for (const EffectSpec& effect : simulator.effects) {
    if (runs_online(effect)) {
      part.effects.push_back(effect);
    } else {
      left_out.push_back(effect.effect);
    }
  }
  return part;
}

StreamingSimulator::StreamingSimulator(const Simulator& simulator, const DerivativeSpec& derivative,
                                       double dt, const std::string& where, Exit exit)
    : model_(changed_tool(simulator.model, simulator.effects)),
      features_(layout_for(model_, derivative, dt)),
      R_ES_(model_.R_ES()) {
  now_.dt = dt;
  for (const EffectSpec& effect : simulator.effects) {
    require(runs_online(effect), exit, where, ": its effect '", effect.effect,
            "' needs the future, a clock of its own, a logged signal or one recording, which an "
            "online sample does not show; leave it out");
  }
  for (const EffectKind* kind : effect_kinds()) {  // in the order in which stages act
    for (const EffectSpec& effect : simulator.effects) {
      if (effect.effect != kind->name || !kind->stream) continue;
      (kind->stage < Stage::kOffset ? before_bias_ : after_bias_)
          .push_back(stream_of(effect, where, exit));
    }
  }
}

StreamingSimulator::StreamingSimulator(StreamingSimulator&&) noexcept = default;
StreamingSimulator::~StreamingSimulator() = default;

void StreamingSimulator::reset() {
  features_.reset();
  now_.first = true;
}

const InstantWrench& StreamingSimulator::push(const Vector3d& position, const Vector3d& euler) {
  now_.p_B = position;
  return advance(features_.push(position, euler), rotation_from_euler(euler), euler);
}

const InstantWrench& StreamingSimulator::push(const Vector3d& position,
                                              const Eigen::Vector4d& quaternion) {
  now_.p_B = position;
  const Eigen::Vector4d q = quaternion.normalized();
  const Eigen::Matrix3d R_BE = rotation_from_quaternion(q);
  return advance(features_.push(position, quaternion), R_BE, euler_from_rotation(R_BE));
}

const InstantWrench& StreamingSimulator::advance(const Eigen::VectorXd& x,
                                                 const Eigen::Matrix3d& R_BE, Vector3d euler) {
  for (int i = 0; i < 3 && !now_.first; ++i) {
    euler[i] = nearest_turn(euler[i], now_.euler[i]);
  }
  now_.euler = euler;
  now_.R_BS = R_BE * R_ES_;
  now_.v_B = now_.R_BS * x.segment<3>(3);
  now_.w_S = x.segment<3>(6);
  now_.a_B = now_.R_BS * x.segment<3>(9);
  now_.dw_S = x.segment<3>(12);
  Vector3d felt = model_.gravity;
  if (model_.inertial != ToolModel::Inertial::kNone) felt -= now_.a_B;
  wrench_ = rigid_at(model_, now_.R_BS.transpose() * felt, now_.w_S, now_.dw_S);
  wrench_.load = wrench_.force;
  wrench_.carried.setZero();
  for (const EffectStream& act : before_bias_) act(wrench_, now_);
  wrench_.force += model_.bias;
  wrench_.torque += model_.bias_torque;
  for (const EffectStream& act : after_bias_) act(wrench_, now_);
  if (!model_.inertia) wrench_.torque.setZero();
  now_.first = false;
  return wrench_;
}

}  // namespace dcnn
