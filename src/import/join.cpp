// SPDX-License-Identifier: Apache-2.0
// Streams of different clocks and rates on the rows of one.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "data/clock.h"
#include "data/spline.h"
#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/clocks.h"
#include "import/stream_table.h"

namespace dcnn {
namespace {

/// Where the rows of one stream fall in another: the knot before each, -1 outside or in a gap.
std::vector<Index> knots_before(const std::vector<double>& at, const std::vector<double>& t) {
  const double step = clock_figures(t).step;
  std::vector<Index> knots;
  for (const double time : at) {
    const Index after = std::upper_bound(t.begin(), t.end(), time) - t.begin();
    const bool exact = after > 0 && t[static_cast<std::size_t>(after - 1)] == time;
    const bool inside = after > 0 && after < static_cast<Index>(t.size());
    const bool whole =
        inside &&
        !is_gap(t[static_cast<std::size_t>(after)] - t[static_cast<std::size_t>(after - 1)], step);
    knots.push_back(exact || whole ? after - 1 : -1);
  }
  return knots;
}

Eigen::VectorXd interpolate_column(const StreamTable& from, Index column,
                                   const std::vector<double>& at, const std::vector<Index>& knots) {
  static const std::set<std::string> kSmooth = {"x",     "y",  "z",  "alpha", "beta",
                                                "gamma", "qw", "qx", "qy",    "qz"};
  const std::string& name = from.columns[static_cast<std::size_t>(column)];
  const Eigen::VectorXd x = from.values.col(column);
  const Eigen::VectorXd t =
      Eigen::Map<const Eigen::VectorXd>(from.t.data(), static_cast<Index>(from.t.size())).array() -
      from.t[0];
  const bool smooth = kSmooth.contains(name) || name.starts_with("q:");
  const Spline spline = smooth ? Spline(t, x) : Spline(t.head(1), x.head(1));
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Index>(at.size()));
  for (std::size_t row = 0; row < at.size(); ++row) {
    const Index k = knots[row];
    if (k < 0) continue;
    const double time = at[row] - from.t[0];
    const Index next = std::min(k + 1, t.size() - 1);
    const double part = next > k ? (time - t[k]) / (t[next] - t[k]) : 0.0;
    out[static_cast<Index>(row)] = smooth && t.size() > 1
                                       ? spline.value(time, std::min(k, t.size() - 2))
                                       : (1.0 - part) * x[k] + part * x[next];
  }
  return out;
}

void keep_rows(const std::vector<Index>& rows, StreamTable* table) {
  Eigen::MatrixXd values(static_cast<Index>(rows.size()), table->values.cols());
  std::vector<double> t;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    values.row(static_cast<Index>(k)) = table->values.row(rows[k]);
    t.push_back(table->t[static_cast<std::size_t>(rows[k])]);
  }
  table->values = std::move(values);
  table->t = std::move(t);
}

std::string hertz(const std::vector<double>& t) {
  std::ostringstream words;
  words.precision(4);
  words << 1.0 / clock_figures(t).step << " Hz";
  return words.str();
}

/// Lists of one length, of which one at most has a clock: each row of one is that of the other.
void join_rows(const StreamTable& from, StreamTable* to, std::vector<std::string>* notes) {
  const char* lacking = from.t.empty() && to->t.empty() ? "neither has a" : "one has no";
  require(from.values.rows() == to->values.rows(), Exit::kData, shown(from.stream), " (",
          from.values.rows(), " rows) and ", shown(to->stream), " (", to->values.rows(),
          " rows) are joined by time, and ", lacking,
          " clock; say --clock, or --rate where they began together");
  if (to->t.empty()) to->t = from.t;
  to->add(from.columns);
  for (std::size_t c = 0; c < from.columns.size(); ++c) {
    to->set(from.columns[c], from.values.col(static_cast<Index>(c)));
  }
  notes->push_back(from.stream + " put beside " + to->stream + " row by row: " + lacking +
                   " clock");
}

void join_one(const StreamTable& from, StreamTable* to, std::vector<std::string>* notes) {
  if (from.t.empty() || to->t.empty()) return join_rows(from, to, notes);
  const auto knots = knots_before(to->t, from.t);
  std::vector<Index> rows;
  for (std::size_t k = 0; k < knots.size(); ++k) {
    if (knots[k] >= 0) rows.push_back(static_cast<Index>(k));
  }
  const ClockFigures a = clock_figures(to->t), b = clock_figures(from.t);
  const bool later = b.begin > a.end;
  require(!rows.empty(), Exit::kData, shown(to->stream), " and ", shown(from.stream),
          " have no time in common: the second one ", later ? "begins " : "ends ",
          later ? b.begin - a.end : a.begin - b.end, later ? " s after" : " s before",
          " the first; see --clock-offset, --stamps and --clock-unit");
  to->add(from.columns);
  for (std::size_t c = 0; c < from.columns.size(); ++c) {
    to->set(from.columns[c], interpolate_column(from, static_cast<Index>(c), to->t, knots));
  }
  std::ostringstream note;
  note << from.stream << " (" << hertz(from.t) << ") put on the clock of " << to->stream << " ("
       << hertz(to->t) << ")";
  if (rows.size() < knots.size()) {
    note << "; " << knots.size() - rows.size() << " rows outside of it or in its gaps left out";
    keep_rows(rows, to);
  }
  notes->push_back(note.str());
}

/// Interpolated quaternions are of unit length again.
void renormalise(StreamTable* table) {
  const Index w = table->find("qw");
  if (w < 0) return;
  const Index at[] = {w, table->find("qx"), table->find("qy"), table->find("qz")};
  for (Index row = 0; row < table->values.rows(); ++row) {
    double square = 0.0;
    for (const Index k : at) square += table->values(row, k) * table->values(row, k);
    for (const Index k : at) table->values(row, k) /= std::sqrt(square);
  }
}

Eigen::Matrix3d wrench_rotation(const StreamTable& table, Index row) {
  const auto at = [&](const char* column) { return table.values(row, table.find(column)); };
  if (table.has("qw")) {
    return Eigen::Quaterniond(at("qw"), at("qx"), at("qy"), at("qz")).toRotationMatrix();
  }
  return (Eigen::AngleAxisd(at("alpha"), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(at("beta"), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(at("gamma"), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d triple(const StreamTable& table, const char* const* columns, Index row) {
  Eigen::Vector3d v;
  for (Index k = 0; k < 3; ++k) v[k] = table.values(row, table.find(columns[k]));
  return v;
}

}  // namespace

StreamTable join_streams(std::vector<StreamTable> tables, std::vector<std::string>* notes) {
  StreamTable joined = std::move(tables.front());
  for (std::size_t k = 1; k < tables.size(); ++k) join_one(tables[k], &joined, notes);
  if (tables.size() > 1) renormalise(&joined);
  return joined;
}

void turn_wrench(const WrenchRule& rule, StreamTable* table, const std::string& file) {
  const bool turned = rule.frame == "base" || !rule.turn.isZero();
  if (!turned && rule.origin.isZero()) return;
  const bool oriented = table->has("qw") || table->has("alpha");
  require(rule.frame != "base" || oriented, Exit::kData, file,
          ": a wrench in the base frame needs an orientation to be turned by");
  static constexpr const char* kForces[] = {"fx", "fy", "fz"};
  static constexpr const char* kTorques[] = {"tx", "ty", "tz"};
  const Eigen::Matrix3d fixed = (Eigen::AngleAxisd(rule.turn.z(), Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(rule.turn.y(), Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(rule.turn.x(), Eigen::Vector3d::UnitX()))
                                    .toRotationMatrix();
  for (Index row = 0; row < table->values.rows(); ++row) {
    Eigen::Matrix3d R = fixed;
    if (rule.frame == "base") R = wrench_rotation(*table, row).transpose();
    Eigen::Vector3d f = Eigen::Vector3d::Zero();
    if (table->has("fx")) {
      f = R * triple(*table, kForces, row);
      for (Index k = 0; k < 3; ++k) table->values(row, table->find(kForces[k])) = f[k];
    }
    if (!table->has("tx")) continue;
    const Eigen::Vector3d torque = R * triple(*table, kTorques, row) + rule.origin.cross(f);
    for (Index k = 0; k < 3; ++k) table->values(row, table->find(kTorques[k])) = torque[k];
  }
}

}  // namespace dcnn
