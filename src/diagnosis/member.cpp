// SPDX-License-Identifier: Apache-2.0
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
  // A column is logged up to half a second after what it tells of, and acts within some seconds.
  static const ShapeParameter lag{.name = "lag", .low = -0.5, .high = 5.0, .seeds = {0.0}};
  if (i < static_cast<Index>(form->shapes.size())) return form->shapes[static_cast<std::size_t>(i)];
  return i < own_shapes() ? lag : lever;
}

int Member::parameters() const {
  const int ends = !interval_s ? 0 : kind->interval == IntervalRule::kOnset ? 1 : 2;
  // A component nothing measures stays 0.
  const auto form_shapes = static_cast<Index>(form->shapes.size());
  const auto fitted = (amplitudes.array() != 0.0).count() +
                      (shapes.tail(shapes.size() - form_shapes).array() != 0.0).count();
  return static_cast<int>(fitted + form_shapes) + ends + (kind->special ? 1 : 0) + (driver ? 1 : 0);
}

bool is_tried(const Case& study, const EffectFit& form) {
  const auto elsewhere = study.axis ? EffectFit::Use::kTools : EffectFit::Use::kMachines;
  if (form.use == elsewhere || form.use == EffectFit::Use::kDriven) return false;
  Index along = 0;
  study.simulator.model.gravity.cwiseAbs().maxCoeff(&along);
  return form.gravity_along < 0 || form.gravity_along == along;
}

const EffectFit& first_form(const Case& study, const EffectKind& kind) {
  const auto tried = [&](const EffectFit& form) { return is_tried(study, form); };
  const auto found = std::find_if(kind.fits.begin(), kind.fits.end(), tried);
  return found != kind.fits.end() ? *found : kind.fits.front();
}

std::optional<Member> plain_form(const Case& study, const Member& member) {
  const EffectFit& form = first_form(study, *member.kind);
  if (!member.form->special || form.special || form.amplitudes != member.form->amplitudes)
    return {};
  Eigen::VectorXd shapes(static_cast<Index>(form.shapes.size()));
  for (std::size_t i = 0; i < form.shapes.size(); ++i) {
    const auto same = std::find_if(
        member.form->shapes.begin(), member.form->shapes.end(),
        [&](const ShapeParameter& s) { return std::string(s.name) == form.shapes[i].name; });
    if (same == member.form->shapes.end()) return {};
    shapes(static_cast<Index>(i)) = member.shapes(same - member.form->shapes.begin());
  }
  return make_member(study, *member.kind, form, member.axis, shapes);
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

namespace {

Member make(const Case& study, const EffectKind& kind, const EffectFit& form,
            const std::string& axis, const Eigen::VectorXd& shapes,
            const std::optional<Case::Driver>& driver) {
  const bool with_torque = study.has_torque();
  const int count = with_torque && form.with_torque > 0 ? form.with_torque : form.amplitudes;
  Member member;
  member.kind = &kind;
  member.form = &form;
  member.axis = axis;
  member.driver = driver;
  member.amplitudes = Eigen::VectorXd::Ones(driver ? 2 : count);
  member.shapes = shapes;
  member.least_shapes = member.most_shapes = shapes;
  for (Index i = 0; i < shapes.size(); ++i) {
    const ShapeParameter& shape = member.shape(i);
    member.least_shapes(i) = unit_of(study, shape) * shape.low;
    member.most_shapes(i) = unit_of(study, shape) * shape.high;
    const auto top = study.top_speed.find(axis);
    if (top == study.top_speed.end()) continue;
    if (shape.speed == ShapeParameter::Speed::kFalling) {
      member.most_shapes(i) = std::max(double(member.most_shapes(i)), top->second);
    }
    if (shape.speed == ShapeParameter::Speed::kTurning) {
      const double within = std::max(0.5 * top->second, member.least_shapes(i));
      member.most_shapes(i) = std::min(double(member.most_shapes(i)), within);
      member.shapes(i) = std::min(double(member.shapes(i)), double(member.most_shapes(i)));
    }
    if (shape.speed == ShapeParameter::Speed::kBending) {
      member.least_shapes(i) = 0.5 * top->second;
      member.most_shapes(i) = 5.0 * top->second;
      member.shapes(i) = std::clamp(double(member.shapes(i)), double(member.least_shapes(i)),
                                    double(member.most_shapes(i)));
    }
  }
  if (with_torque && has_lever(kind)) add_lever(member);
  return member;
}

}  // namespace

bool is_undriven(const Member& plain, const Member& driven) {
  return driven.driver && !plain.driver && plain.kind == driven.kind && plain.axis == driven.axis;
}

std::vector<Member> with_member(std::vector<Member> members, const Member& more) {
  std::erase_if(members, [&](const Member& m) { return is_undriven(m, more); });
  members.push_back(more);
  return members;
}

Member make_member(const Case& study, const EffectKind& kind, const EffectFit& form,
                   const std::string& axis, const Eigen::VectorXd& shapes) {
  return make(study, kind, form, axis, shapes, std::nullopt);
}

Member make_driven(const Case& study, const EffectKind& kind, const EffectFit& form,
                   const std::string& axis, const Eigen::VectorXd& shapes,
                   const Case::Driver& driver) {
  return make(study, kind, form, axis, shapes, driver);
}

bool is_at_bound(const Member& member, Index shape) {
  const double most = member.most_shapes(shape), least = member.least_shapes(shape);
  const double size = 1e-3 * std::max(std::abs(most), std::abs(least));
  return member.shapes(shape) > most - size || (least < 0.0 && member.shapes(shape) < least + size);
}

bool is_degenerate(const Member& member) {
  for (Index i = 0; i < member.own_shapes(); ++i) {
    if (is_at_bound(member, i)) return true;
  }
  return false;
}

void leave_out_lag(Member& member) {
  const Index lag = member.own_shapes() - 1;
  member.shapes(lag) = member.least_shapes(lag) = member.most_shapes(lag) = 0.0;
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
  const auto shapes = static_cast<Index>(member.form->shapes.size());
  Eigen::VectorXd amplitudes = member.amplitudes;
  double slope = 0.0;
  if (member.driver) {  // a straight line through the strengths at the ends of the range
    const auto& [signal, low, high] = *member.driver;
    slope = (amplitudes(1) - amplitudes(0)) / (high - low);
    amplitudes = Eigen::VectorXd::Constant(1, amplitudes(0) - slope * low);
  }
  Json parameters = member.form->parameters(amplitudes, member.shapes.head(shapes));
  if (member.driver) {
    parameters["slope"] = slope;
    parameters["lag_s"] = member.shapes(shapes);
  }
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
  Json parameters = parameters_of(member);
  if (member.driver) parameters["driven_by"] = member.driver->signal;
  return {member.kind->name, member.axis, member.interval_s, parameters, member.recording};
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
