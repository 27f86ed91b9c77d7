// SPDX-License-Identifier: Apache-2.0
#include "physics/effect_law.h"

namespace dcnn::effects::inertial_terms {
namespace {

void change(ToolModel& model, Options&) { model.inertial = ToolModel::Inertial::kFull; }

}  // namespace

const EffectKind effect{
    .name = "inertial_terms",
    .stage = Stage::kTool,
    .kind = "structural",
    .meaning = "simulation leaves inertial terms out",
    .equation = "model.inertial -> full",
    .interval = IntervalRule::kNever,
    .force = Shown::kInMotion,
    .torque = Shown::kInMotion,
    .change = change,
    .fits = {{.parameters = [](const Eigen::VectorXd&,
                               const Eigen::VectorXd&) { return Json::object(); }}},
    .hidden_by =
        [](const Showing& of) {
          if (!of.own_tool) return kUnknownTool;
          return of.is_full ? "the simulator has all inertial terms" : nullptr;
        },
    .words = [](const FoundNumbers&) -> std::string {
      return "the simulation leaves out inertial terms that the recordings show";
    },
};

}  // namespace dcnn::effects::inertial_terms
