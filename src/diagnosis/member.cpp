#include "diagnosis/member.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/elementary.h"

namespace dcnn {

bool same_family(const Member& a, const Member& b) {
  return a.axis == b.axis && std::string_view(a.kind->kind) == b.kind->kind;
}

bool Member::is_held(Index amplitude) const {
  return std::any_of(held.begin(), held.end(),
                     [amplitude](const Held& h) { return h.amplitude == amplitude; });
}

void Member::hold(Index amplitude, double low, double high) {
  amplitudes(amplitude) = 0.0;
  held.push_back({amplitude, low, high});
}

bool has_entries(const Member& member) {
  const Stage stage = member.kind->stage;
  const bool vector = stage == Stage::kTool || stage == Stage::kSensor || stage == Stage::kOffset;
  return vector && !member.fixed && !member.form->non_negative && member.amplitudes.size() > 1;
}

const ShapeParameter& Member::shape(Index i) const {
  // A force on a tool acts within a metre of the sensor.
  static const ShapeParameter lever{.name = "lever", .low = -1.0, .high = 1.0, .seeds = {0.0}};
  return i < own_shapes() ? form->shapes[static_cast<std::size_t>(i)] : lever;
}

int Member::parameters() const {
  const int ends = !interval_s ? 0 : kind->interval == IntervalRule::kOnset ? 1 : 2;
  // A component nothing measures stays 0.
  const auto fitted =
      (amplitudes.array() != 0.0).count() + (shapes.tail(levers()).array() != 0.0).count();
  return static_cast<int>(fitted + own_shapes()) + ends + (kind->special ? 1 : 0);
}

double unit_of(const Case& study, const ShapeParameter& shape) {
  return elementary::pow(study.axis_length, shape.length) *
         elementary::pow(study.axis_seconds, shape.time);
}

namespace {

/// The components of the lever that make a torque: all, or those across an axis that S holds.
std::vector<Index> told_by_torque(const Member& member) {
  const std::string line = member.axis.substr(member.axis.find(':') + 1);
  if (line.empty() || line.starts_with("base_")) return {0, 1, 2};
  const Index along = line.back() - 'x';
  return {(along + 1) % 3, (along + 2) % 3};
}

}  // namespace

Member make_member(const Case& study, const EffectKind& kind, const EffectFit& form,
                   const std::string& axis, const Eigen::VectorXd& shapes) {
  const bool with_torque = study.has_torque();
  const int count = with_torque && form.with_torque > 0 ? form.with_torque : form.amplitudes;
  Member member;
  member.kind = &kind;
  member.form = &form;
  member.axis = axis;
  member.amplitudes = Eigen::VectorXd::Ones(count);
  member.shapes = shapes;
  member.least_shapes = member.most_shapes = shapes;
  for (Index i = 0; i < shapes.size(); ++i) {
    const ShapeParameter& shape = member.shape(i);
    member.least_shapes(i) = unit_of(study, shape) * shape.low;
    member.most_shapes(i) = unit_of(study, shape) * shape.high;
  }
  if (with_torque && has_lever(kind)) add_lever(member);
  return member;
}

bool is_degenerate(const Member& member) {
  for (Index i = 0; i < member.own_shapes(); ++i) {
    const double most = member.most_shapes(i);
    const double size = 1e-3 * std::max(std::abs(most), std::abs(member.least_shapes(i)));
    if (member.shapes(i) > most - size) return true;
  }
  return false;
}

void add_lever(Member& member) {
  const Index own = member.shapes.size(),
              levers = static_cast<Index>(told_by_torque(member).size());
  for (Eigen::VectorXd* numbers : {&member.shapes, &member.least_shapes, &member.most_shapes}) {
    numbers->conservativeResize(own + levers);
  }
  for (Index i = own; i < own + levers; ++i) {
    member.shapes(i) = 0.0;
    member.least_shapes(i) = member.shape(i).low;
    member.most_shapes(i) = member.shape(i).high;
  }
}

void leave_out_lever(Member& member) {
  const Index own = member.own_shapes();
  for (Eigen::VectorXd* numbers : {&member.shapes, &member.least_shapes, &member.most_shapes}) {
    numbers->conservativeResize(own);
  }
}

Eigen::Vector3d lever_of(const Member& member) {
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();
  if (member.levers() == 0) return lever;
  const auto told = told_by_torque(member);
  for (std::size_t k = 0; k < told.size(); ++k) {
    lever(told[k]) = member.shapes(member.own_shapes() + static_cast<Index>(k));
  }
  return lever;
}

Json parameters_of(const Member& member) {
  Json parameters =
      member.form->parameters(member.amplitudes, member.shapes.head(member.own_shapes()));
  if (member.levers() == 0) return parameters;
  const Eigen::Vector3d lever = lever_of(member);
  for (const Index i : told_by_torque(member)) {
    parameters[std::string("lever_") + "xyz"[i] + "_m"] = lever(i);
  }
  return parameters;
}

EffectSpec spec_of(const Member& member) {
  if (!member.law.is_null()) {
    Json parameters = member.law_parameters;
    parameters["amplitude_n"] = member.amplitudes(0) * parameters["amplitude_n"].get<double>();
    parameters.update(parameters_of(member));
    return {member.kind->name, "", std::nullopt, parameters, "", member.law};
  }
  return {member.kind->name, member.axis, member.interval_s, parameters_of(member),
          member.recording};
}

std::vector<EffectSpec> specs_of(const std::vector<Member>& members) {
  std::vector<EffectSpec> specs;
  specs.reserve(members.size());
  for (const Member& member : members) specs.push_back(spec_of(member));
  return specs;
}

double search_scale(const ShapeParameter& shape, double value) {
  return shape.low > 0.0 ? elementary::log(value) : value;
}

double from_search_scale(const Member& member, Index i, double coordinate) {
  const ShapeParameter& shape = member.shape(i);
  const double value = shape.low > 0.0 ? elementary::exp(coordinate) : coordinate;
  const double most = member.most_shapes(i);
  return std::clamp(value, std::min(member.least_shapes(i), most), most);
}

}  // namespace dcnn
