#include "diagnosis/member.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/elementary.h"

namespace dcnn {

bool same_family(const Member& a, const Member& b) {
  return a.axis == b.axis && std::string_view(a.kind->kind) == b.kind->kind;
}

int Member::parameters() const {
  const int ends = !interval_s ? 0 : kind->interval == IntervalRule::kOnset ? 1 : 2;
  const auto fitted = (amplitudes.array() != 0.0).count();  // a component nothing measures stays 0
  return static_cast<int>(fitted + shapes.size()) + ends + (kind->special ? 1 : 0);
}

Member make_member(const EffectKind& kind, const EffectFit& form, const std::string& axis,
                   bool with_torque, const Eigen::VectorXd& shapes) {
  const int count = with_torque && form.with_torque > 0 ? form.with_torque : form.amplitudes;
  Member member;
  member.kind = &kind;
  member.form = &form;
  member.axis = axis;
  member.amplitudes = Eigen::VectorXd::Ones(count);
  member.shapes = shapes;
  return member;
}

EffectSpec spec_of(const Member& member) {
  if (!member.law.is_null()) {
    return {member.kind->name, "", std::nullopt, member.law_parameters, "", member.law};
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
  const double least = member.least_shapes.size() > i ? member.least_shapes(i) : shape.low;
  const double most = member.most_shapes.size() > i ? member.most_shapes(i) : shape.high;
  return std::clamp(value, std::min(least, most), most);
}

}  // namespace dcnn
