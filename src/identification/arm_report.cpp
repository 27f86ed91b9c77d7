// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/lists.h"
#include "dcnn/core/number.h"
#include "dcnn/identification/arm.h"

namespace dcnn {
namespace {

template <class... Args>
std::string arm_line(const char* format, Args... args) {
  char line[300];
  std::snprintf(line, sizeof line, format, args...);
  return line;
}

const IdentifiedNumber* parameter_of(const JointEstimate& joint, const std::string& name) {
  for (const IdentifiedNumber& e : joint.parameters) {
    if (e.name == name) return &e;
  }
  return nullptr;
}

bool clear_of_zero(const IdentifiedNumber* e) { return e && (e->low > 0.0 || e->high < 0.0); }

/// Dry friction that would push in the direction of the motion.
bool drives(const JointEstimate& joint) {
  const IdentifiedNumber* fc = parameter_of(joint, "fc");
  return fc && fc->high < 0.0;
}

/// "joints 1 to 6" of the joints for which `has` holds; by name where they are not all in a row.
template <class Has>
std::string joints_with(const std::vector<JointEstimate>& joints, const Has& has) {
  std::vector<std::size_t> found;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (has(joints[j])) found.push_back(j);
  }
  if (found.empty()) return "";
  if (found.size() > 2 && found.back() - found.front() + 1 == found.size()) {
    return "joints " + std::to_string(found.front() + 1) + " to " +
           std::to_string(found.back() + 1);
  }
  std::string text = found.size() > 1 ? "joints " : "joint ";
  for (std::size_t k = 0; k < found.size(); ++k) {
    text += (k > 0 ? ", " : "") + std::to_string(found[k] + 1);
  }
  return text;
}

std::string summary(const ArmIdentification& id) {
  std::vector<std::string> parts;
  if (!id.payload.empty()) {
    const double m = id.payload[0].value;
    double off = 0.0;
    for (std::size_t k = 1; k < id.payload.size(); ++k) {
      if (id.payload[k].shown) off = std::hypot(off, id.payload[k].value);
    }
    parts.push_back(
        id.payload[0].shown
            ? arm_line("payload of %.3g kg, centre %.2g cm off the flange", m, 100.0 * off)
            : arm_line("no payload above %.2g kg", id.payload[0].high));
  }
  const std::pair<const char*, const char*> words[] = {
      {"fc", "dry friction"},
      {"c", "viscous friction"},
      {"mu", "friction that grows with the load"},
      {"c2", "viscous friction that changes with speed"},
      {"fs_over_fc", "dry friction that changes with speed"}};
  for (const auto& [stem, text] : words) {
    const std::string name = stem;
    const std::string where = joints_with(id.joints, [&](const JointEstimate& joint) {
      return clear_of_zero(parameter_of(joint, name)) && !(name == "fc" && drives(joint));
    });
    if (!where.empty()) parts.push_back(text + (" on " + where));
  }
  if (const std::string where = joints_with(id.joints, drives); !where.empty()) {
    parts.push_back("dry friction that would drive " + where +
                    ", so that their torques have the wrong sign or are the reaction to the "
                    "drives': give these axes \"scale\": -1");
  }
  if (parts.empty()) parts.push_back("the links and the drives' offsets, nothing else");
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text + ".\n";
}

Json estimate_list(const std::vector<IdentifiedNumber>& estimates) {
  Json all = Json::object();
  for (const IdentifiedNumber& e : estimates) {
    Json one{{"value", e.value}, {"unit", e.unit}};
    one["ci95"] = Json::array({e.low, e.high});
    all[e.name] = one;
  }
  return all;
}

}  // namespace

Json to_json(const ArmIdentification& id) {
  Json joints = Json::array(), links = Json::array();
  for (const JointEstimate& joint : id.joints) {
    Json one{{"axis", joint.name},
             {"unit", joint.unit},
             {"parameters", estimate_list(joint.parameters)},
             {"presliding", joint.presliding},
             {"creep_s", joint.creep_s},
             {"torque_rms", joint.torque_rms},
             {"residual_rms", joint.residual_rms}};
    one["holdout_rms"] = joint.holdout_rms ? Json(*joint.holdout_rms) : Json();
    joints.push_back(one);
  }
  for (const LinkEstimate& link : id.links) {
    Json shown = Json::array();
    for (const bool s : link.shown) shown.push_back(s);
    links.push_back(Json{{"axis", link.name},
                         {"order", kLinkParameters},
                         {"value", json_list(link.body)},
                         {"deviation", json_list(link.deviation)},
                         {"shown", shown}});
  }
  return {{"recordings", id.recordings},
          {"holdout", id.holdout},
          {"lowpass_hz", id.lowpass_hz},
          {"base_parameters", id.base_parameters},
          {"payload", estimate_list(id.payload)},
          {"joints", joints},
          {"links", links},
          {"words", summary(id)},
          {"notes", id.notes}};
}

std::string to_text(const ArmIdentification& id) {
  std::string text = summary(id);
  for (const IdentifiedNumber& e : id.payload) {
    if (!e.shown) {
      text += arm_line("  %-12s not shown by these recordings\n", e.name.c_str());
      continue;
    }
    text += arm_line("  %-12s %9.4f  [%.4f, %.4f] %s\n", e.name.c_str(), e.value, e.low, e.high,
                     unit_text(e.unit).c_str());
  }
  if (id.lowpass_hz == 0.0) {
    text += arm_line(
        "%d combinations of inertial parameters are told by these poses at rest; friction "
        "and rotors' inertias show in motion alone.\n",
        id.base_parameters);
    text += "  joint          torque   residual  held out\n";
  } else {
    text += arm_line(
        "%d combinations of inertial parameters are told by these motions; torques and "
        "regressors low-passed at %.3g Hz.\n",
        id.base_parameters, id.lowpass_hz);
    text += "  joint          torque   residual  held out   dry        viscous    path     creep\n";
  }
  for (const JointEstimate& joint : id.joints) {
    const IdentifiedNumber *fc = parameter_of(joint, "fc"), *c = parameter_of(joint, "c");
    const std::string held =
        joint.holdout_rms ? arm_line("%-9.3g", *joint.holdout_rms) : std::string("-        ");
    if (id.lowpass_hz == 0.0) {
      text += arm_line("  %-12s %8.3g   %-9.3g %s  [%s]\n", joint.name.c_str(), joint.torque_rms,
                       joint.residual_rms, held.c_str(), unit_text(joint.unit).c_str());
      continue;
    }
    text += arm_line("  %-12s %8.3g   %-9.3g %s  %-9.3g  %-9.3g  %-7.2g  %.2g s  [%s]\n",
                     joint.name.c_str(), joint.torque_rms, joint.residual_rms, held.c_str(),
                     fc ? fc->value : 0.0, c ? c->value : 0.0, joint.presliding, joint.creep_s,
                     unit_text(joint.unit).c_str());
  }
  return text;
}

}  // namespace dcnn
