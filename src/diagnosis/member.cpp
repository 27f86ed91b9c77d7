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

int Member::parameters() const {
  const int ends = !interval_s ? 0 : kind->interval == IntervalRule::kOnset ? 1 : 2;
  const auto fitted = (amplitudes.array() != 0.0).count();  // a component nothing measures stays 0
  return static_cast<int>(fitted + shapes.size()) + ends + (kind->special ? 1 : 0);
}

double unit_of(const Case& study, const ShapeParameter& shape) {
  return elementary::pow(study.axis_length, shape.length) *
         elementary::pow(study.axis_seconds, shape.time);
}

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
    const ShapeParameter& shape = form.shapes[static_cast<std::size_t>(i)];
    member.least_shapes(i) = unit_of(study, shape) * shape.low;
    member.most_shapes(i) = unit_of(study, shape) * shape.high;
  }
  return member;
}

bool is_degenerate(const Member& member) {
  for (Index i = 0; i < member.shapes.size(); ++i) {
    const double most = member.most_shapes(i);
    const double size = 1e-3 * std::max(std::abs(most), std::abs(member.least_shapes(i)));
    if (member.shapes(i) > most - size) return true;
  }
  return false;
}

EffectSpec spec_of(const Member& member) {
  if (!member.law.is_null()) {
    Json parameters = member.law_parameters;
    parameters["amplitude_n"] = member.amplitudes(0) * parameters["amplitude_n"].get<double>();
    return {member.kind->name, "", std::nullopt, parameters, "", member.law};
  }
  return {member.kind->name, member.axis, member.interval_s,
          member.form->parameters(member.amplitudes, member.shapes), member.recording};
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
  const ShapeParameter& shape = member.form->shapes[static_cast<std::size_t>(i)];
  const double value = shape.low > 0.0 ? elementary::exp(coordinate) : coordinate;
  const double most = member.most_shapes(i);
  return std::clamp(value, std::min(member.least_shapes(i), most), most);
}

}  // namespace dcnn
