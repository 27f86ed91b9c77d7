// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "dcnn/core/number.h"
#include "physics/effect_law.h"

namespace dcnn::effects::inertia_tensor {
namespace {

constexpr std::array kEntries{"delta_inertia_xx_kgm2", "delta_inertia_yy_kgm2",
                              "delta_inertia_zz_kgm2", "delta_inertia_xy_kgm2",
                              "delta_inertia_xz_kgm2", "delta_inertia_yz_kgm2"};

void change(ToolModel& model, Options& parameters) {
  Eigen::Matrix<double, kEntries.size(), 1> d;
  for (std::size_t k = 0; k < kEntries.size(); ++k) {
    d(static_cast<Index>(k)) = parameter(parameters, kEntries[k]);
  }
  if (!model.inertia) return;  // no torque is simulated
  *model.inertia += Eigen::Matrix3d{{d(0), d(3), d(4)}, {d(3), d(1), d(5)}, {d(4), d(5), d(2)}};
}

}  // namespace

const EffectKind effect{
    .name = "inertia_tensor",
    .stage = Stage::kTool,
    .kind = "parameter",
    .meaning = "another inertia tensor",
    .equation = "I -> I + d, about the sensor's origin",
    .example = R"({"delta_inertia_xx_kgm2": 0.004, "delta_inertia_yy_kgm2": 0.003,
                   "delta_inertia_zz_kgm2": 0.001, "delta_inertia_xy_kgm2": 0.0005,
                   "delta_inertia_xz_kgm2": -0.0003, "delta_inertia_yz_kgm2": 0.0002})",
    .interval = IntervalRule::kNever,
    .force = Shown::kNever,
    .torque = Shown::kInMotion,
    .change = change,
    .fits = {{.with_torque = static_cast<int>(kEntries.size()),
              .parameters =
                  [](const Eigen::VectorXd& a, const Eigen::VectorXd&) {
                    Json parameters = Json::object();
                    for (std::size_t k = 0; k < kEntries.size(); ++k) {
                      parameters[kEntries[k]] = a(static_cast<Index>(k));
                    }
                    return parameters;
                  }}},
    .hidden_by = [](const Showing& of) { return of.own_tool ? nullptr : kUnknownTool; },
    .words =
        [](const FoundNumbers& n) {
          const auto most = std::max_element(n.all().begin(), n.all().end(),
                                             [](const FoundNumber& a, const FoundNumber& b) {
                                               return std::abs(a.value) < std::abs(b.value);
                                             });
          return "the tool's inertia tensor is off, most of all by " + brief(most->value) + " " +
                 most->unit + " (" + most->stem.substr(most->stem.size() - 2) + ")";
        },
};

}  // namespace dcnn::effects::inertia_tensor
