// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/axes.h"

#include <algorithm>
#include <cmath>

#include "dcnn/physics/axis_machine.h"
#include "diagnosis/arm_words.h"
#include "diagnosis/axis_words.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

/// A finding of the chain (a force on a tool along x) as the axis' own.
Json outer_finding(Json finding, const AxisPlan& plan) {
  const Axis& axis = plan.axis();
  const EffectKind& kind = *find_effect(finding["effect"].get<std::string>());
  if (finding.contains("law")) {  // told in the axis' terms
    finding["axis"] = axis.name;
    return finding;
  }
  Json parameters = Json::object();
  std::string strength;  // of a law that a logged signal drives
  for (const auto& [name, number] : finding["parameters"].items()) {
    if (number["value"].is_string()) {
      parameters[name] = number;
      continue;
    }
    const auto outer = axis_parameter(kind, name, axis, plan.sense);
    if (!outer) continue;
    const auto moved = [&, s = outer->sign, d = outer->shift](const Json& v) {
      return s * v.get<double>() + d;
    };
    double low = moved(number["ci95"][0]), high = moved(number["ci95"][1]);
    if (low > high) std::swap(low, high);
    if (kind.strength != nullptr && name == kind.strength) strength = outer->stem;
    parameters[outer->stem] = {
        {"value", moved(number["value"])}, {"ci95", {low, high}}, {"unit", outer->unit}};
  }
  if (parameters.contains("driven_by")) {
    parameters["slope"]["unit"] = per_signal(parameters[strength]["unit"], parameters["driven_by"]);
  }
  finding["parameters"] = parameters;
  finding["axis"] = axis.name;
  finding["words"] = axis_words(finding, axis, strength);
  return finding;
}

void append(Json& list, const Json& more) {
  for (const Json& entry : more) list.push_back(entry);
}

/// How much of the machine's excess is on each axis, in units of the axes' floors.
std::vector<double> shares_of(const std::vector<Json>& reports) {
  std::vector<double> energy;
  double all = 0.0;
  for (const Json& report : reports) {
    const double floor = report["fit"]["noise_floor"][0].get<double>();
    const double ratio =
        report["where"]["axes"][0]["excess_rms"].get<double>() / std::max(1e-300, floor);
    energy.push_back(ratio * ratio);
    all += energy.back();
  }
  for (double& e : energy) e = all > 0.0 ? e / all : 0.0;
  return energy;
}

Json merged_places(const std::vector<Json>& reports, const System& system) {
  const auto shares = shares_of(reports);
  Json where{{"axes", Json::array()},
             {"segments", Json::array()},
             {"regimes", Json::array()},
             {"bands", Json::array()},
             {"budget", Json::array()}};
  for (std::size_t k = 0; k < reports.size(); ++k) {
    for (auto& [key, list] : where.items()) {
      for (Json entry : reports[k]["where"][key]) {
        entry["axis"] = system.axes[k].name;
        entry["share"] = entry["share"].get<double>() * shares[k];
        list.push_back(entry);
      }
    }
  }
  return where;
}

std::string merged_verdict(const std::vector<Json>& reports) {
  bool named = false, remains = false;
  for (const Json& report : reports) {
    const std::string verdict = report["verdict"];
    named |= verdict == "explained" || verdict == "partly-explained";
    remains |= verdict == "unexplained" || verdict == "partly-explained";
  }
  if (named) return remains ? "partly-explained" : "explained";
  return remains ? "unexplained" : "consistent";
}

/// A figure of every target; null of those of an axis that lacks it (nothing of it was held out).
template <class Figure>
Json of_all_targets(const std::vector<Json>& reports, Figure figure) {
  Json all = Json::array();
  bool any = false;
  for (const Json& report : reports) {
    const Json own = figure(report["fit"]);
    any |= own.is_array();
    if (own.is_array()) {
      append(all, own);
    } else {
      for (std::size_t j = 0; j < report["targets"].size(); ++j) all.push_back(nullptr);
    }
  }
  return any ? all : Json();
}

Json merged_errors(const std::vector<Json>& reports) {
  Json fit = reports.front()["fit"];
  for (auto& [key, value] : fit.items()) {
    const std::string name = key;
    if (!value.is_object()) {
      value = of_all_targets(reports, [&](const Json& one) { return one.value(name, Json()); });
      continue;
    }
    for (auto& [inner, values] : value.items()) {
      const std::string part = inner;
      values = of_all_targets(reports, [&](const Json& one) {
        return one.value(name, Json::object()).value(part, Json());
      });
    }
  }
  return fit;
}

Json merged_unnamed(const std::vector<Json>& reports, const System& system) {
  Json part{{"excess_rms", Json::array()},
            {"remains", Json::array()},
            {"formula", nullptr},
            {"words", nullptr}};
  std::string words;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    for (const char* key : {"excess_rms", "remains"}) append(part[key], reports[k]["unnamed"][key]);
    if (reports[k]["unnamed"]["words"].is_null()) continue;
    words += (words.empty() ? "" : "; ") + reports[k]["unnamed"]["words"].get<std::string>() +
             " on " + system.axes[k].name;
  }
  if (!words.empty()) part["words"] = words;
  return part;
}

Json merged(const std::vector<Json>& reports, const System& system) {
  Json report = reports.front();
  report["verdict"] = merged_verdict(reports);
  report["where"] = merged_places(reports, system);
  report["fit"] = merged_errors(reports);
  report["unnamed"] = merged_unnamed(reports, system);
  report.erase("posterior");
  report.erase("structures");
  for (std::size_t k = 0; k < reports.size(); ++k) {
    report["posteriors"].push_back(reports[k]["posterior"]);
    report["posteriors"].back()["axis"] = system.axes[k].name;
    report["posteriors"].back()["structures"] = reports[k]["structures"];
  }
  for (const char* key :
       {"targets", "units", "findings", "refuted", "left_out", "not_detected", "not_testable"}) {
    report[key] = Json::array();
    for (const Json& one : reports) append(report[key], one[key]);
  }
  report["next_motion"] = nullptr;
  report["smoother_hz"] = Json::array();
  Json search{{"passes", 0.0}, {"complete", true}};
  for (const Json& one : reports) {
    search["passes"] = search["passes"].get<double>() + one["search"]["passes"].get<double>();
    if (!one["search"]["complete"]) search["complete"] = false;
    if (report["next_motion"].is_null()) report["next_motion"] = one["next_motion"];
    report["smoother_hz"].push_back(one["smoother_hz"]);
  }
  report["search"] = search;
  if (system.lowpass_hz > 0.0) report["lowpass_hz"] = system.lowpass_hz;
  if (system.resample_hz > 0.0) report["resample_hz"] = system.resample_hz;
  return report;
}

void translate(Diagnosis& diagnosis, const AxisPlan& plan) {
  const Axis& axis = plan.axis();
  for (Json& finding : diagnosis.report["findings"]) finding = outer_finding(finding, plan);
  for (const char* key : {"refuted", "not_detected", "not_testable"}) {
    for (Json& entry : diagnosis.report[key]) entry["axis"] = axis.name;
  }
  if (axis.has_base && axis.base.empty()) {  // nothing was said to be known of it
    for (Json& share : diagnosis.report["fit"]["holdout_explained_before"]) share = nullptr;
  }
  for (HeldOut& record : diagnosis.holdout) {
    for (auto* signal : {&record.measured, &record.before, &record.after}) *signal *= -plan.sense;
  }
  for (Portrait& portrait : diagnosis.portraits) {
    portrait.title = axis.name + ": " + portrait.title;
    portrait.y_label = axis.measured + " [" + axis.unit + "]";
    if (portrait.x_label.starts_with("velocity")) {
      portrait.x_label = "velocity [" + axis.position_unit + "/s]";
    } else if (portrait.x_label.starts_with("angle")) {
      portrait.x_label = "position [" + axis.position_unit + "]";
    }
    for (auto* list : {&portrait.left, &portrait.law}) {
      for (double& y : *list) y *= -plan.sense;
    }
  }
}

/// The held-out columns of another axis beside those at hand.
void join(std::vector<HeldOut>& records, const std::vector<HeldOut>& more) {
  const auto beside = [](Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    a.conservativeResize(Eigen::NoChange, a.cols() + b.cols());
    a.rightCols(b.cols()) = b;
  };
  for (std::size_t k = 0; k < records.size(); ++k) {
    beside(records[k].measured, more[k].measured);
    beside(records[k].before, more[k].before);
    beside(records[k].after, more[k].after);
  }
}

/// A finding of the whole machine, before those of its axes.
void add_first(const Json& finding, Json& report) {
  Json findings = Json::array();
  findings.push_back(finding);
  append(findings, report["findings"]);
  report["findings"] = findings;
  const bool remains =
      report["verdict"] == "unexplained" || report["verdict"] == "partly-explained";
  report["verdict"] = remains ? "partly-explained" : "explained";
}

}  // namespace

Diagnosis diagnose_axes(const DiagnosisRequest& request,
                        const std::function<void(const std::string&)>& progress) {
  auto [cases, finding, simulator] = load_axes(request);
  const System system = cases.front().fit.axis->system;
  AxisMachine machine{system, {}};
  machine.payload = cases.front().fit.axis->payload;
  std::vector<Json> reports;
  double uncorrected = 0.0, corrected = 0.0;
  Diagnosis all;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const auto plan = cases[k].fit.axis;
    auto [diagnosis, base, given] =
        diagnose_case(std::move(cases[k]), [&](const std::string& text) {
          if (progress) progress(plan->axis().name + ": " + text);
        });
    machine.axes.push_back({plan->columns, base, diagnosis.corrected.effects,
                            diagnosis.corrected.derivative.value_or(DerivativeSpec{}),
                            plan->sense});
    translate(diagnosis, *plan);
    reports.push_back(diagnosis.report);
    for (const double error : given) uncorrected += error;
    const Json& after = diagnosis.report["fit"]["holdout_rmse_after"];
    for (const Json& error : after.is_null() ? Json::array() : after) {
      corrected += error.get<double>();
    }
    if (k == 0) {
      all.holdout = std::move(diagnosis.holdout);
    } else {
      join(all.holdout, diagnosis.holdout);
    }
    for (Portrait& p : diagnosis.portraits) all.portraits.push_back(std::move(p));
  }
  all.report = merged(reports, system);
  all.report["joints"] = joints_json(reports, system);
  if (!finding.is_null()) {
    if (uncorrected > 0.0) finding["holdout_gain"] = 1.0 - corrected / uncorrected;
    add_first(finding, all.report);
  }
  if (!system.arm.is_null()) all.report["arm"] = arm_json(all.report, system);
  all.model = to_json(simulator ? with_more(std::move(*simulator), machine) : machine);
  return all;
}

}  // namespace dcnn
