// SPDX-License-Identifier: Apache-2.0
#include "conceal/arm_draw.h"
#include "dcnn/conceal/arm.h"
#include "dcnn/conceal/challenge.h"
#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "dcnn/data/csv.h"

namespace dcnn::conceal {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Eigen::Vector3d;

Json three(const Vector3d& v) { return {v(0), v(1), v(2)}; }

/// Mass, first moment, and the inertia about the frame's origin as sums over the masses.
Json body_of(const std::vector<PointMass>& masses) {
  double m = 0.0;
  Vector3d moment = Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const PointMass& point : masses) {
    m += point.mass;
    moment += point.mass * point.at;
    inertia += point.mass * (point.at.squaredNorm() * Eigen::Matrix3d::Identity() -
                             point.at * point.at.transpose());
  }
  const Json six{inertia(0, 0), inertia(0, 1), inertia(0, 2),
                 inertia(1, 1), inertia(1, 2), inertia(2, 2)};
  return {{"mass_kg", m}, {"moment_kgm", three(moment)}, {"inertia_kgm2", six}};
}

Json system_of(const ArmScenario& s) {
  Json axes = Json::array();
  std::vector<std::string> names;
  for (std::size_t j = 0; j < s.limbs.size(); ++j) {
    const std::string number = std::to_string(j + 1);
    Json axis{{"name", "joint" + number},
              {"measured", "tau_" + number},
              {"unit", "N*m"},
              {"position", "q_" + number}};
    if (!s.described) axis["simulated"] = "tau_" + number + "_sim";
    axes.push_back(axis);
    names.push_back("joint" + number);
  }
  return {
      {"kind", "axes"}, {"axes", axes}, {"arm", arm_json(s.limbs, s.flange, names, s.described)}};
}

Table table_of(const ArmScenario& s, const ArmLog& log) {
  const Index n = log.q.cols();
  Table table;
  table.columns = {"t"};
  table.values.resize(log.t.size(), 1 + (s.described ? 2 : 3) * n);
  table.values.leftCols(1 + 2 * n) << log.t, log.q, log.measured;
  if (!s.described) table.values.rightCols(n) = log.simulated;
  for (const char* stem : {"q_", "tau_", "sim"}) {
    const bool simulated = std::string(stem) == "sim";
    for (Index j = 1; j <= n && (!simulated || !s.described); ++j) {
      table.columns.push_back(simulated ? "tau_" + std::to_string(j) + "_sim"
                                        : stem + std::to_string(j));
    }
  }
  return table;
}

Json arm_truth(const ArmScenario& s) {
  Json all{{"drawn", s.id},
           {"group", s.group},
           {"family", "arm"},
           {"motion", std::to_string(s.limbs.size()) + " joints"}};
  all["noise"] = {{"kind", s.noise}, {"sigma_nm", s.sigma}, {"encoder_rad", s.encoder}};
  all["described"] = s.described;
  all["hidden"] = Json::array();
  for (const Hidden& h : s.hidden) {
    Json one{{"effect", h.effect},      {"axis", h.axis.empty() ? Json() : Json(h.axis)},
             {"interval_s", nullptr},   {"parameters", Json::object()},
             {"listed", true},          {"foreign", false},
             {"amplitude", h.amplitude}};
    if (h.interval_s) one["interval_s"] = {h.interval_s->first, h.interval_s->second};
    for (const auto& [name, value] : h.parameters) one["parameters"][name] = value;
    all["hidden"].push_back(one);
  }
  Json oracle = Json::array();
  for (const ArmLog& log : s.logs) {
    for (Index j = 0; log.holdout && j < log.q.cols(); ++j) {
      oracle.push_back(std::sqrt((log.measured - log.clean).col(j).array().square().mean()));
    }
  }
  all["oracle_rmse"] = oracle;
  return all;
}

Json write_arm(const ArmScenario& s, const fs::path& folder) {
  fs::create_directories(folder);
  write_file(folder / "system.json", system_of(s).dump(2) + "\n");
  std::vector<std::string> files{"system.json"};
  for (const ArmLog& log : s.logs) {
    files.push_back(log.name + ".csv");
    write_csv(folder / files.back(), table_of(s, log));
  }
  Json digests = Json::object();
  for (const std::string& file : files) {
    digests[file] = sha256_hex({read_file(folder / file, std::size_t{1} << 30, Exit::kData)});
  }
  return digests;
}

}  // namespace

Json arm_json(const std::vector<Limb>& limbs, const Vector3d& flange,
              const std::vector<std::string>& names, bool with_bodies) {
  Json joints = Json::array();
  for (std::size_t j = 0; j < limbs.size(); ++j) {
    const double roll = std::atan2(limbs[j].turned(2, 1), limbs[j].turned(2, 2));
    Json joint{
        {"name", names[j]}, {"xyz_m", three(limbs[j].origin)}, {"rpy_rad", {roll, 0.0, 0.0}}};
    if (with_bodies) joint["body"] = body_of(limbs[j].masses);
    joints.push_back(joint);
  }
  return {{"joints", joints},
          {"flange", {{"xyz_m", three(flange)}}},
          {"gravity_mps2", three(kGravity)}};
}

std::string conceal_arms(const std::vector<std::string>& ids, std::uint64_t seed,
                         const fs::path& folder, const fs::path& seal,
                         const std::function<void(int, int)>& progress) {
  return seal_each(ids, seed, folder, seal, progress, [&](const auto& id, const auto& place) {
    const ArmScenario scenario = draw_arm(id, seed);
    Json answer = arm_truth(scenario);
    answer["sha256"] = write_arm(scenario, place);
    return answer;
  });
}

}  // namespace dcnn::conceal
