// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "conceal/world.h"
#include "dcnn/conceal/scenario.h"
#include "dcnn/core/file.h"
#include "dcnn/data/csv.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
constexpr double kEnds = 0.5;  // s

Json list(const Eigen::Vector3d& v) { return {v(0), v(1), v(2)}; }

Json nominal(const Tool& tool, double hz) {
  Json sim;
  sim["tool"]["mass_kg"] = tool.mass;
  sim["tool"]["com_m"] = list(tool.com);
  sim["gravity_mps2"] = list(kGravity);
  sim["sensor"]["bias_n"] = list(tool.bias);
  if (!tool.beads.empty()) {
    const Eigen::Matrix3d I = inertia_of(tool);
    sim["tool"]["inertia_kgm2"] = {I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)};
    sim["sensor"]["bias_nm"] = list(tool.bias_torque);
  }
  if (!tool.mounting.isZero()) sim["sensor"]["rotation_rpy"] = list(tool.mounting);
  sim["model"]["inertial"] = tool.inertial;
  sim["sample_rate_hz"] = hz;
  return sim;
}

Table table_of(const Recorded& r) {
  Table table{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"}, {}};
  const bool thermometer = r.temperature.size() > 0;
  if (r.measured.cols() == 6) {
    for (const char* torque : {"tx", "ty", "tz"}) table.columns.emplace_back(torque);
  }
  const auto read = static_cast<Index>(table.columns.size());
  table.values.resize(r.t.size(), read + (thermometer ? 1 : 0));
  table.values.leftCols(read) << r.t, r.pose, r.measured;
  if (thermometer) {
    table.columns.emplace_back("temperature");
    table.values.col(read) = r.temperature;
  }
  return table;
}

Json oracle(const Scenario& s) {
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(s.recordings.front().measured.cols());
  double rows = 0.0;
  for (const Recorded& r : s.recordings) {
    if (!r.holdout) continue;
    const auto ends = static_cast<Index>(kEnds * s.conditions.hz());
    const Index n = r.clean.rows() - 2 * ends;
    squares += (r.measured - r.clean).middleRows(ends, n).colwise().squaredNorm();
    rows += static_cast<double>(n);
  }
  if (rows == 0.0) return nullptr;
  Json all = Json::array();
  for (const double square : squares) all.push_back(std::sqrt(square / rows));
  return all;
}

Json answer(const Hidden& h) {
  Json one;
  one["effect"] = h.effect;
  one["axis"] = h.axis.empty() ? Json() : Json(h.axis);
  one["interval_s"] = h.interval_s ? Json{h.interval_s->first, h.interval_s->second} : Json();
  one["parameters"] = Json::object();
  for (const auto& [name, value] : h.parameters) one["parameters"][name] = value;
  if (h.parameters.count("slope") != 0) one["driven_by"] = "temperature";
  one["listed"] = is_listed(h.effect);
  one["foreign"] = h.foreign;
  one["amplitude"] = h.amplitude;
  return one;
}

}  // namespace

Files write(const Scenario& s, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  Files files;
  files.simulator = folder / "sim.json";
  write_file(files.simulator, nominal(s.tool, s.conditions.hz()).dump(2) + "\n");
  for (const Recorded& r : s.recordings) {
    (r.holdout ? files.holdout : files.fit).push_back(folder / (r.name + ".csv"));
    write_csv(folder / (r.name + ".csv"), table_of(r));
  }
  return files;
}

Json truth(const Scenario& s) {
  const Conditions& c = s.conditions;
  Json all{{"drawn", s.id}, {"group", s.group}, {"family", c.family}, {"motion", s.motion}};
  if (c.family != "plain") {
    all["conditions"] = {{"hz", c.hz()},           {"tremor_hz", c.tremor_hz},
                         {"tremor_m", c.tremor_m}, {"tremor_rad", c.tremor_rad},
                         {"axis", list(c.axis)},   {"growth_per_n", c.growth},
                         {"burst", c.burst},       {"lost", c.lost},
                         {"jitter", c.jitter},     {"torque_m", c.torque_m}};
  }
  all["noise"] = {{"kind", s.noise.kind},
                  {"sigma_n", s.noise.sigma},
                  {"pose_m", s.noise.pose_m},
                  {"pose_rad", s.noise.pose_rad}};
  all["hidden"] = Json::array();
  for (const Hidden& h : s.hidden) all["hidden"].push_back(answer(h));
  all["oracle_rmse"] = oracle(s);
  return all;
}

}  // namespace dcnn::conceal
