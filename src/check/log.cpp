// SPDX-License-Identifier: Apache-2.0
#include "dcnn/check/log.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "check/statistics.h"
#include "data/clock.h"
#include "data/near_names.h"

namespace dcnn::check {
namespace {

using Names = std::vector<std::string>;
constexpr double kSmoothRatio = 0.05;      // of von Neumann's ratio, 2 for rows in any order
constexpr std::size_t kFewestBursts = 20;  // whose lengths agree by chance next to never
constexpr double kRegular = 0.9;           // of bursts that are of one length

Eigen::Index find_column(const Table& table, const std::string& name) {
  const auto it = std::find(table.columns.begin(), table.columns.end(), name);
  return it == table.columns.end() ? -1 : it - table.columns.begin();
}

std::vector<Joint> declared_joints(const System& system) {
  std::vector<Joint> joints;
  for (const Axis& axis : system.axes) {
    const bool turns = axis.position_unit.empty() ? axis.unit != "N" : axis.position_unit != "m";
    joints.push_back({axis.name, axis.position, axis.velocity, axis.measured, turns, axis.scale});
  }
  return joints;
}

/// q_elbow with qd_elbow or tau_elbow, as dcnn-import writes them.
void add_named_joints(const Log& log, std::vector<Joint>& joints) {
  for (const std::string& column : log.table.columns) {
    if (!column.starts_with("q_")) continue;
    const std::string name = column.substr(2), rate = "qd_" + name, torque = "tau_" + name;
    const bool known = std::any_of(joints.begin(), joints.end(),
                                   [&](const Joint& joint) { return joint.position == column; });
    if (known || (!log.has(rate) && !log.has(torque))) continue;
    joints.push_back(
        {name, column, log.has(rate) ? rate : "", log.has(torque) ? torque : "", true});
  }
}

/// q_1 or q1 with qd_1 and tau_1, as arms are logged.
std::vector<Joint> recognised_joints(const Log& log) {
  std::vector<Joint> joints;
  const auto first = [&](const Names& stems, const std::string& k) -> std::string {
    for (const std::string& stem : stems) {
      if (log.has(stem + k)) return stem + k;
    }
    return "";
  };
  for (int k = 0; k <= 32; ++k) {
    const std::string number = std::to_string(k);
    const std::string q = first({"q_", "q"}, number);
    if (q.empty()) continue;
    joints.push_back({"joint " + number, q, first({"qd_", "qd", "dq_", "dq"}, number),
                      first({"tau_", "tau", "i_A_"}, number), true});
  }
  add_named_joints(log, joints);
  return joints;
}

/// Columns of joints have names of their own: q_x is no qx of a quaternion.
Names columns_without_joints(const Log& log) {
  Names columns;
  for (const std::string& column : log.table.columns) {
    const bool joint = std::any_of(log.joints.begin(), log.joints.end(), [&](const Joint& one) {
      return column == one.position || column == one.velocity || column == one.measured;
    });
    if (!joint) columns.push_back(column);
  }
  return columns;
}

/// Von Neumann's ratio of the pose's columns, the median of those that move.
double neighbours_ratio(const Log& log) {
  std::vector<double> ratios;
  for (const std::string& name : log.positions()) {
    const Eigen::VectorXd x = log.column(name);
    if (!varies(x)) continue;
    const double spread = (x.array() - x.mean()).square().sum();
    // Angles and quaternions may jump by a turn or a sign: the few largest steps are left out.
    Eigen::VectorXd steps = steps_of(x).cwiseAbs2();
    std::sort(steps.begin(), steps.end());
    ratios.push_back(steps.head(steps.size() - steps.size() / 50).sum() / spread);
  }
  if (ratios.empty()) return 0.0;
  return median(
      Eigen::Map<Eigen::VectorXd>(ratios.data(), static_cast<Eigen::Index>(ratios.size())));
}

/// Rows of a burst where a source hands over so many at once (packets of USB or a network): pieces
/// between gaps are of one length, nearly all; 0 elsewhere. Gaps of a recording come as they like.
Eigen::Index burst_of(const std::vector<Segment>& segments) {
  if (segments.size() < kFewestBursts) return 0;
  std::vector<Eigen::Index> lengths;
  for (const Segment& piece : segments) lengths.push_back(piece.end - piece.begin);
  std::sort(lengths.begin(), lengths.end());
  const Eigen::Index usual = lengths[lengths.size() / 2];
  const auto alike = std::count(lengths.begin(), lengths.end(), usual);
  return static_cast<double>(alike) > kRegular * static_cast<double>(lengths.size()) ? usual : 0;
}

std::vector<Segment> segments_of(const Log& log) {
  std::vector<Segment> segments{{0, log.rows()}};
  for (Eigen::Index i = 1; i < log.t.size(); ++i) {
    if (!is_gap(log.t[i] - log.t[i - 1], log.step)) continue;
    segments.back().end = i;
    segments.push_back({i, log.rows()});
  }
  return segments;
}

}  // namespace

bool Log::has(const std::string& column_name) const { return find_column(table, column_name) >= 0; }

bool Log::has_all(const Names& columns) const {
  return std::all_of(columns.begin(), columns.end(),
                     [&](const std::string& column_name) { return has(column_name); });
}

Eigen::VectorXd Log::column(const std::string& column_name) const {
  const Eigen::Index k = find_column(table, column_name);
  require(k >= 0, Exit::kData, name, ":1: column '", column_name, "' is missing; add it");
  return table.values.col(k);
}

Eigen::MatrixXd Log::block(const Names& columns) const {
  Eigen::MatrixXd out(rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    out.col(static_cast<Eigen::Index>(k)) = column(columns[k]);
  }
  return out;
}

bool Log::is_wrist() const {
  return declared.system.kind == System::Kind::kWrist && has_pose() && has_all({"fx", "fy", "fz"});
}

std::vector<Names> Log::sensors() const {
  std::vector<Names> sensors;
  for (const Names& names : {Names{"fx", "fy", "fz"}, Names{"tx", "ty", "tz"}}) {
    if (has_all(names)) sensors.push_back(names);
  }
  for (const Joint& joint : joints) {
    if (!joint.measured.empty()) sensors.push_back({joint.measured});
  }
  return sensors;
}

Names Log::positions() const {
  Names names;
  for (const Names& some : {kPosition, has_quaternion() ? kQuaternion : kEuler}) {
    if (has_all(some)) names.insert(names.end(), some.begin(), some.end());
  }
  for (const Joint& joint : joints) {
    if (!joint.position.empty()) names.push_back(joint.position);
  }
  return names;
}

Log make_log(const std::string& name, Table table, const Declared& declared) {
  Log log{name, std::move(table), declared, {}, {}, {}, 0.0, false, {}, 0};
  const bool axes = declared.system.kind == System::Kind::kAxes;
  log.joints = axes ? declared_joints(declared.system) : recognised_joints(log);
  for (const Joint& joint : log.joints) {
    for (const std::string& column : {joint.position, joint.velocity, joint.measured}) {
      require(column.empty() || log.has(column), Exit::kData, name, ":1: column '", column,
              "' of axis '", joint.name, "' is missing; add it or correct the system description");
    }
  }
  if (log.has("t")) {
    log.t = log.column("t");
    if (log.t.size() > 0) log.t.array() -= double(log.t[0]);
    log.step = median(steps_of(log.t));
  }
  log.smooth = log.rows() >= kFewRows && neighbours_ratio(log) < kSmoothRatio;
  log.segments = log.step > 0.0 ? segments_of(log) : std::vector<Segment>{{0, log.rows()}};
  log.burst = burst_of(log.segments);
  if (log.burst > 0) {  // rows are as regular as their number, their stamps are not
    log.step = log.t[log.rows() - 1] / static_cast<double>(log.rows() - 1);
    log.segments = {{0, log.rows()}};
  }
  return log;
}

void describe_arm(Log& log, const JointChain& chain) {
  const std::size_t joints = chain.joints.size(), logged = log.joints.size();
  const auto place_of = [&](const ChainJoint& joint) {
    const auto it = std::find_if(log.joints.begin(), log.joints.end(),
                                 [&](const Joint& own) { return own.name == joint.name; });
    return static_cast<std::size_t>(it - log.joints.begin());
  };
  std::vector<std::size_t> places;
  for (const ChainJoint& joint : chain.joints) places.push_back(place_of(joint));
  if (std::find(places.begin(), places.end(), logged) != places.end()) {  // names of their own
    require(logged == joints, Exit::kData, log.name, ":1: columns of ", logged,
            " joints (such as q_1, qd_1, tau_1), the arm described has ", joints,
            "; name the columns by --system, or the arm's end by --tip");
    std::iota(places.begin(), places.end(), std::size_t{0});
  }
  for (const std::size_t place : places) {
    const Joint& joint = log.joints[place];
    require(!joint.position.empty() && !joint.measured.empty(), Exit::kData, log.name,
            ":1: joint '", joint.name, "' has no column of its ",
            joint.position.empty() ? "position" : "torque",
            "; add it, or describe no arm (without --urdf)");
  }
  log.arm = std::move(places);
  log.declared.arm = chain;
}

Log read_log(const std::filesystem::path& path, const Declared& declared) {
  Log log = make_log(path.filename().string(), read_table(path).table, declared);
  refuse_near_names(columns_without_joints(log), declared.system, path.string());
  return log;
}

}  // namespace dcnn::check
