// SPDX-License-Identifier: Apache-2.0
// The offset between the clocks of two streams: from a log, in words and as a picture.
#include <algorithm>
#include <cmath>
#include <iomanip>

#include "dcnn/core/error.h"
#include "dcnn/core/excerpt.h"
#include "dcnn/import/assemble.h"
#include "import/clocks.h"
#include "import/stream_table.h"

namespace dcnn {
namespace {

constexpr Index kMostOffsetRows =
    100'000;  // of the force that are compared: a limit of computation

Eigen::MatrixXd columns_of(const StreamTable& table, const std::vector<std::string>& names) {
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(table.values.rows(), static_cast<Index>(names.size()));
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Index at = table.find(names[k]);
    if (at >= 0) out.col(static_cast<Index>(k)) = table.values.col(at);
  }
  return out;
}

/// Angles about z, y', x'' as quaternions.
void add_quaternion(StreamTable* table) {
  if (!table->has("alpha")) return;
  Eigen::MatrixXd q(table->values.rows(), 4);
  const Eigen::MatrixXd angles = columns_of(*table, {"alpha", "beta", "gamma"});
  for (Index row = 0; row < q.rows(); ++row) {
    const Eigen::Quaterniond turn = Eigen::AngleAxisd(angles(row, 0), Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(angles(row, 1), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(angles(row, 2), Eigen::Vector3d::UnitX());
    q.row(row) << turn.w(), turn.x(), turn.y(), turn.z();
    if (row > 0 && q.row(row).dot(q.row(row - 1)) < 0.0) q.row(row) *= -1.0;
  }
  const char* names[] = {"qw", "qx", "qy", "qz"};
  for (Index k = 0; k < 4; ++k) table->set(names[k], q.col(k));
}

std::string milliseconds(double seconds) {
  std::ostringstream words;
  words << std::setprecision(3) << 1e3 * seconds << " ms";
  return words.str();
}

/// A point of the picture; y grows downwards.
struct Frame {
  double left = 70, top = 20, width = 500, height = 220;
  double x0, x1, y0, y1;
  double x(double value) const { return left + width * (value - x0) / (x1 - x0); }
  double y(double value) const { return top + height * (y1 - value) / (y1 - y0); }
};

}  // namespace

StreamOffset estimate_offset(const ForeignLog& log, const Recipe& recipe, double most_s) {
  StreamOffset result;
  StreamTable force, pose;
  std::vector<std::string> notes;
  for (const ClockRule& clock : recipe.clocks) {
    std::vector<StreamTable> tables = make_stream_tables(log, recipe, clock, &notes);
    if (tables.size() > 1) continue;  // of one clock
    convert_orientation(recipe, &tables[0], log.file);
    add_quaternion(&tables[0]);
    const bool turns = tables[0].has("qw");
    if (tables[0].has("fx")) force = turns ? tables[0] : std::move(tables[0]);
    if (turns) pose = std::move(tables[0]);
  }
  if (force.stream.empty() || pose.stream.empty() || force.stream == pose.stream) return result;
  if (force.t.empty() || pose.t.empty() || !force.has("fy") || !force.has("fz")) return result;
  ClockPair pair;
  pair.step = std::max(clock_figures(force.t).step, clock_figures(pose.t).step);
  const double origin = force.t.front();
  std::vector<Index> rows;
  const Index stride = 1 + static_cast<Index>(force.t.size()) / kMostOffsetRows;
  for (Index row = 0; row < static_cast<Index>(force.t.size()); row += stride) {
    rows.push_back(row);
    pair.t.push_back(force.t[static_cast<std::size_t>(row)] - origin);
  }
  for (const double t : pose.t) pair.pose_t.push_back(t - origin);
  pair.force = columns_of(force, {"fx", "fy", "fz"})(rows, Eigen::all);
  pair.pose = columns_of(pose, {"x", "y", "z", "qw", "qx", "qy", "qz"});
  result.stream = pose.stream;
  result.offset = estimate_clock_offset(pair, most_s);
  return result;
}

std::string words_of(const StreamOffset& estimate) {
  const ClockOffset& offset = estimate.offset;
  if (offset.shifts.empty()) {
    return "offset between the clocks: too little in common to estimate it";
  }
  const double half = offset.half;
  const std::string interval = "(95 %: " + milliseconds(offset.seconds - half) + " to " +
                               milliseconds(offset.seconds + half) + ")";
  if (offset.certain && std::abs(offset.seconds) < half) {
    return "the clock of " + excerpt(estimate.stream, 80) + " is that of the force: offset " +
           milliseconds(offset.seconds) + " " + interval;
  }
  return "offset of the clock of " + excerpt(estimate.stream, 80) + ": " +
         milliseconds(offset.seconds) + " to add " + interval +
         (offset.certain
              ? "; not applied: say --clock-offset " + excerpt(estimate.stream, 80) + "=auto"
              : "; too uncertain to be applied");
}

std::string picture_of(const StreamOffset& estimate) {
  const ClockOffset& offset = estimate.offset;
  if (offset.shifts.empty()) return "";
  const auto [low, high] =
      std::minmax_element(offset.residual_rms.begin(), offset.residual_rms.end());
  Frame frame{};
  frame.x0 = offset.shifts.front();
  frame.x1 = offset.shifts.back();
  frame.y0 = 0.0;
  frame.y1 = std::max(*high, 1e-12) * 1.05;
  std::ostringstream svg;
  svg << std::setprecision(5)
      << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 600 300\" "
         "font-family=\"sans-serif\" "
         "font-size=\"12\"><rect width=\"600\" height=\"300\" fill=\"white\"/>\n<polyline "
         "fill=\"none\" "
         "stroke=\"#0072b2\" stroke-width=\"2\" points=\"";
  for (std::size_t k = 0; k < offset.shifts.size(); ++k) {
    svg << frame.x(offset.shifts[k]) << "," << frame.y(offset.residual_rms[k]) << " ";
  }
  svg << "\"/>\n";
  const double half = offset.half;
  svg << "<rect x=\"" << frame.x(std::max(frame.x0, offset.seconds - half)) << "\" y=\""
      << frame.top << "\" width=\""
      << std::max(1.0, frame.width * 2.0 * half / (frame.x1 - frame.x0)) << "\" height=\""
      << frame.height << "\" fill=\"#d55e00\" fill-opacity=\"0.35\"/>\n";
  svg << "<line x1=\"" << frame.left << "\" x2=\"" << frame.left + frame.width << "\" y1=\""
      << frame.top + frame.height << "\" y2=\"" << frame.top + frame.height
      << "\" stroke=\"black\"/>\n";
  const auto text = [&](double x, double y, const std::string& words) {
    svg << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"middle\">" << words
        << "</text>\n";
  };
  for (const double x : {frame.x0, 0.0, frame.x1}) {
    text(frame.x(x), frame.top + frame.height + 16, milliseconds(x));
  }
  text(320, 282,
       "offset added to the pose's clock: " + milliseconds(offset.seconds) + " within " +
           milliseconds(half) + " (95 %)");
  std::ostringstream least;
  least << std::setprecision(3) << *low << " N";
  text(35, frame.y(*low), least.str());
  svg << "<text x=\"16\" y=\"130\" transform=\"rotate(-90 16 130)\" text-anchor=\"middle\">left of "
         "the "
         "force, N rms</text>\n</svg>\n";
  return svg.str();
}

}  // namespace dcnn
