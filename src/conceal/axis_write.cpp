// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "conceal/axis_draw.h"
#include "core/elementary.h"
#include "dcnn/conceal/axis.h"
#include "dcnn/conceal/challenge.h"
#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "dcnn/data/csv.h"
#include "dcnn/data/filter.h"

namespace dcnn::conceal {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Eigen::VectorXd;

/// Columns that a linear simulator of the axis is made of.
std::vector<std::string> base_of(const AxisScenario& s) {
  std::vector<std::string> base;
  if (s.form != "base") return base;
  base.emplace_back("acceleration");
  if (s.body.viscous > 0.0) base.emplace_back("velocity");
  if (s.body.stiffness > 0.0) base.emplace_back("position");
  if (s.body.gravity != 0.0) base.insert(base.end(), {"sin_q", "cos_q"});
  return base;
}

Json axis_system(const AxisScenario& s) {
  Json axis{{"name", s.name},
            {"measured", "effort"},
            {"unit", s.body.unit},
            {"position", "q"},
            {"position_unit", s.body.position_unit}};
  if (s.log.velocity_hz > 0.0) axis["velocity"] = "qd";
  if (s.form == "simulated") {
    axis["simulated"] = "effort_sim";
  } else {
    axis["base"] = base_of(s);
  }
  Json system{{"kind", "axes"}, {"axes", Json::array({axis})}};
  if (s.log.lowpass_hz > 0.0) system["lowpass_hz"] = s.log.lowpass_hz;
  return system;
}

Table axis_table(const AxisScenario& s, const AxisRecording& r) {
  Table table;
  table.columns = {"t", "q", "effort"};
  std::vector<VectorXd> values{r.t, r.q, r.measured};
  const auto add = [&](const char* name, const VectorXd& column) {
    table.columns.emplace_back(name);
    values.push_back(column);
  };
  if (r.velocity.size() > 0) add("qd", r.velocity);
  if (s.form == "simulated") add("effort_sim", r.simulated);
  if (s.form == "base" && s.body.gravity != 0.0) {  // as its user computes them from the log
    const double w = 2.0 * 3.141592653589793 / s.body.turn;
    const auto digits = [](double x) { return std::round(x * 1e9) / 1e9; };
    add("sin_q", r.q.unaryExpr([&](double q) { return digits(elementary::sin(w * q)); }));
    add("cos_q", r.q.unaryExpr([&](double q) { return digits(elementary::cos(w * q)); }));
  }
  table.values.resize(r.t.size(), static_cast<Index>(values.size()));
  for (std::size_t k = 0; k < values.size(); ++k)
    table.values.col(static_cast<Index>(k)) = values[k];
  return table;
}

/// Other names for the same force on these recordings.
Json aliases_of(const AxisScenario& s, const Hidden& h) {
  Json names = Json::array();
  const AxisBody& b = s.body;
  const bool all_inertia = s.form == "simulated" && b.viscous == 0.0 && b.gravity == 0.0 &&
                           b.stiffness == 0.0 && b.weight == 0.0;
  if (all_inertia && h.effect == "gain") names.push_back("inertia");
  if (all_inertia && h.effect == "inertia") names.push_back("gain");
  // A settling of which less than half is seen is a line.
  if (h.effect == "thermal_drift" && h.parameters.at("tau_s") > 2.0 * s.span) {
    names.push_back("linear_drift");
  }
  return names;
}

/// True of the log, and not hidden: a velocity that is filtered lags the effort, which leads it.
Json optional_names(const AxisScenario& s) {
  Json list = Json::array();
  const auto add = [&](const char* id) {
    const bool hidden = std::any_of(s.hidden.begin(), s.hidden.end(),
                                    [&](const Hidden& h) { return h.effect == id; });
    if (!hidden) list.push_back(id);
  };
  if (s.log.velocity_hz > 0.0) add("time_delay");
  if (s.log.digit > 0.0) add("quantisation");
  return list;
}

}  // namespace

double axis_oracle(const AxisScenario& s) {
  double square = 0.0, rows = 0.0;
  for (const AxisRecording& r : s.recordings) {
    if (!r.holdout) continue;
    Eigen::MatrixXd left = r.measured - r.clean;
    if (s.log.lowpass_hz > 0.0) {
      left = low_pass(left, {{0, left.rows()}}, 1.0 / s.log.hz, s.log.lowpass_hz);
    }
    for (Index i = 0; i < left.rows(); ++i) {
      if (!r.fresh[static_cast<std::size_t>(i)]) continue;
      square += left(i, 0) * left(i, 0);
      rows += 1.0;
    }
  }
  return std::sqrt(square / rows);
}

namespace {

Json write_axis(const AxisScenario& s, const fs::path& folder) {
  fs::create_directories(folder);
  write_file(folder / "system.json", axis_system(s).dump(2) + "\n");
  std::vector<std::string> files{"system.json"};
  for (const AxisRecording& r : s.recordings) {
    files.push_back(r.name + ".csv");
    write_csv(folder / files.back(), axis_table(s, r));
  }
  Json digests = Json::object();
  for (const std::string& file : files) {
    digests[file] = sha256_hex({read_file(folder / file, std::size_t{1} << 30, Exit::kData)});
  }
  return digests;
}

}  // namespace

Json axis_truth(const AxisScenario& s) {
  const AxisLogging& log = s.log;
  Json all{{"drawn", s.id},      {"group", s.group},       {"family", "axis"},
           {"motion", s.motion}, {"machine", s.body.kind}, {"simulator", s.form}};
  all["noise"] = {{"kind", log.noise}, {"sigma", log.sigma}};
  all["log"] = {{"hz", log.hz},
                {"encoder", log.encoder},
                {"counts", log.counts},
                {"jitter", log.jitter},
                {"lost", log.lost},
                {"held", log.held},
                {"filter_s", log.filter_s},
                {"lowpass_hz", log.lowpass_hz},
                {"velocity_hz", log.velocity_hz},
                {"held_out_motion", s.recordings.back().motion}};
  all["hidden"] = Json::array();
  for (const Hidden& h : s.hidden) {
    const bool listed = !is_axis_law(h.effect);
    Json one{{"effect", h.effect},         {"axis", s.name},
             {"interval_s", nullptr},      {"parameters", Json::object()},
             {"listed", listed},           {"foreign", false},
             {"amplitude", h.amplitude},   {"class", axis_class(h.effect)},
             {"aliases", aliases_of(s, h)}};
    if (h.interval_s) one["interval_s"] = {h.interval_s->first, h.interval_s->second};
    for (const auto& [name, value] : h.parameters) one["parameters"][name] = value;
    all["hidden"].push_back(one);
  }
  all["optional"] = optional_names(s);
  all["oracle_rmse"] = {axis_oracle(s)};
  return all;
}

std::string conceal_axes(const std::vector<std::string>& ids, std::uint64_t seed,
                         const fs::path& folder, const fs::path& seal,
                         const std::function<void(int, int)>& progress) {
  return seal_each(ids, seed, folder, seal, progress, [&](const auto& id, const auto& place) {
    const AxisScenario scenario = draw_axis_scenario(id, seed);
    Json answer = axis_truth(scenario);
    answer["sha256"] = write_axis(scenario, place);
    return answer;
  });
}

}  // namespace dcnn::conceal
