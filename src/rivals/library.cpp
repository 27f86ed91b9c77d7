// SPDX-License-Identifier: Apache-2.0
#include "rivals/library.h"

#include <algorithm>

namespace dcnn::rivals {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
constexpr double kStep = 1e-3;  // of an amplitude, for the derivative at zero
constexpr std::size_t kShapes = 3;

bool searched_for(const EffectKind& kind, const EffectFit& fit) {
  if (kind.interval == IntervalRule::kRequired || kind.interval == IntervalRule::kOnset)
    return true;
  return std::any_of(fit.shapes.begin(), fit.shapes.end(),
                     [](const ShapeParameter& s) { return s.seeds.empty(); });
}

/// The k-th seed of every shape, up to three.
std::vector<VectorXd> seeds_of(const EffectFit& fit) {
  std::size_t count = 1;
  for (const ShapeParameter& s : fit.shapes) count = std::max(count, s.seeds.size());
  std::vector<VectorXd> all;
  for (std::size_t k = 0; k < std::min(count, kShapes); ++k) {
    VectorXd shapes(static_cast<Index>(fit.shapes.size()));
    for (std::size_t j = 0; j < fit.shapes.size(); ++j) {
      const auto& seeds = fit.shapes[j].seeds;
      shapes(static_cast<Index>(j)) = seeds[k % seeds.size()];
    }
    all.push_back(shapes);
  }
  return all;
}

VectorXd flat(const Eigen::MatrixXd& force) { return force.reshaped(); }

}  // namespace

std::vector<Law> library(bool thermometer) {
  std::vector<Law> laws;
  for (const EffectKind* kind : effect_kinds()) {
    if (kind->force == Shown::kNever) continue;  // the scenarios have forces alone
    std::vector<std::string> axes = admitted_axes(kind->axis);
    if (axes.empty()) axes.emplace_back();
    for (const EffectFit& fit : kind->fits) {
      if (fit.use == EffectFit::Use::kDriven) continue;
      if (fit.gravity_along >= 0 && fit.gravity_along != 2) continue;  // the scenarios' is along z
      if (fit.parameters == nullptr || searched_for(*kind, fit)) continue;
      for (const VectorXd& shapes : seeds_of(fit)) {
        const Json names = fit.parameters(VectorXd::Ones(fit.amplitudes), shapes);
        if (names.contains("t_ref_degc") && !thermometer) continue;
        for (const std::string& axis : axes) laws.push_back({kind->name, axis, &fit, shapes});
      }
    }
  }
  return laws;
}

std::vector<Group> groups_of(const std::vector<Law>& laws) {
  std::vector<Group> groups;
  Index at = 0;
  for (const Law& law : laws) {
    groups.push_back({at, at + std::max(1, law.fit->amplitudes)});
    at = groups.back().end;
  }
  return groups;
}

namespace {

VectorXd force_of(const Law& law, const VectorXd& amplitudes, const ToolModel& tool,
                  const Motion& motion) {
  EffectSpec spec;
  spec.effect = law.effect;
  spec.axis = law.axis;
  spec.parameters = law.fit->parameters(amplitudes, law.shapes);
  return flat(simulate({tool, {spec}}, motion).force);
}

}  // namespace

Eigen::MatrixXd columns_of(const std::vector<Law>& laws, const ToolModel& tool,
                           const Motion& motion) {
  const std::vector<Group> groups = groups_of(laws);
  const VectorXd plain = flat(simulate({tool, {}}, motion).force);
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(plain.size(), groups.back().end);
  for (std::size_t k = 0; k < laws.size(); ++k) {
    const Index begin = groups[k].begin, count = laws[k].fit->amplitudes;
    VectorXd amplitudes = VectorXd::Zero(count);
    if (count > 0) amplitudes(0) = kStep;
    const VectorXd first = force_of(laws[k], amplitudes, tool, motion);
    X.col(begin) = (first - plain) / (count > 0 ? kStep : 1.0);
    for (Index a = 1; a < count; ++a) {  // beside the first: a spring without stiffness has no rest
      amplitudes(a) = kStep;
      X.col(begin + a) = (force_of(laws[k], amplitudes, tool, motion) - first) / kStep;
      amplitudes(a) = 0.0;
    }
  }
  return X;
}

}  // namespace dcnn::rivals
