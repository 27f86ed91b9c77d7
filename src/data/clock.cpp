// SPDX-License-Identifier: Apache-2.0
#include "data/clock.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "data/kept_rows.h"
#include "data/limits.h"

namespace dcnn {
namespace {

constexpr double kEpoch = 1e6;        // s; a larger t is a date, not a duration
constexpr double kGap = 5.0;          // times dt, the longest step that is none
constexpr double kOff = 0.2;          // of dt, by which jitter may be off
constexpr double kTolerated = 0.01;   // of the steps
constexpr double kMostLost = 0.1;     // of the rows; with more the median step is no clock's
constexpr double kPoses = 1.0;        // s; between rows further apart a hand or an arm moves unseen
constexpr Index kRowsPerPeriod = 40;  // of a motion; poses one by one are chosen further apart

std::string place(const std::string& file, Index row) {
  return file + ":" + std::to_string(row + 2);  // the header is line 1
}

void check_increasing(const Eigen::VectorXd& t, const std::string& file) {
  for (Index i = 1; i < t.size(); ++i) {
    const double step = t[i] - t[i - 1];
    if (step > 0.0 && std::isfinite(step)) continue;
    require(step != 0.0, Exit::kData, place(file, i), ": column 't' repeats ", t[i],
            "; remove the repeated row");
    fail(Exit::kData, place(file, i), ": column 't' goes from ", t[i - 1], " to ", t[i],
         "; time must increase: sort the rows, or cut the recording where its clock was set");
  }
}

double median_step(const Eigen::VectorXd& t) {
  if (t.size() < 2) return 0.0;
  Eigen::VectorXd steps = t.tail(t.size() - 1) - t.head(t.size() - 1);
  const auto middle = steps.begin() + steps.size() / 2;
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// The step of a clock: the median, but where rows counted at it leave their own stamps by more
/// than half a step in all, stamps jitter, or are rounded: then the mean. (Of N steps of relative
/// jitter s the median is wrong by 1.25 s/sqrt(N), the mean by 1.4 s/N; forces go with its square.)
double step_of(const Eigen::VectorXd& t, double median) {
  const StepCount count = count_steps(t, median, kOff);
  return std::abs(count.time - count.ticks) > 0.5 ? median * count.time / count.ticks : median;
}

/// The decimal digit to which the numbers were rounded, at most 1; 0 where they have many digits.
double last_digit(const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  constexpr double kFinest = 1e-9, kWhole = 1e-6;
  for (double digit = 1.0; digit > kFinest; digit *= 0.1) {
    const Eigen::ArrayXd places = numbers.array() / digit;
    if ((places - places.round()).abs().maxCoeff() < kWhole) return digit;
  }
  return 0.0;
}

/// One line of all gaps, with the first ones and the longest.
std::string words_of_gaps(const Eigen::VectorXd& t, const std::vector<Segment>& segments) {
  constexpr std::size_t kFew = 3;
  std::ostringstream words;
  words << segments.size() - 1 << " gap" << (segments.size() == 2 ? "" : "s") << " before t = ";
  double longest = 0.0, before = 0.0;  // s
  for (std::size_t k = 1; k < segments.size(); ++k) {
    const double end = t[segments[k].begin], gap = end - t[segments[k].begin - 1];
    if (gap > longest) longest = gap, before = end;
    if (k <= kFew) words << (k > 1 ? ", " : "") << end;
  }
  words << (segments.size() > kFew + 1 ? ", … s" : " s") << ": split there; the longest of "
        << longest << " s before t = " << before << " s";
  return words.str();
}

/// Von Neumann's ratio of orientations, mean squared step over twice the variance: 1 for poses in
/// any order, 1 - cos(2π/N) for a motion of N rows a period.
double step_ratio(const Recording& recording) {
  for (const auto& columns : {std::vector<std::string>{"qw", "qx", "qy", "qz"},
                              std::vector<std::string>{"alpha", "beta", "gamma"}}) {
    if (!recording.has_all(columns) || recording.samples() < 3) continue;
    const Eigen::MatrixXd x = recording.block(columns);
    const Index n = x.rows();
    const double steps = (x.bottomRows(n - 1) - x.topRows(n - 1)).squaredNorm();
    const double spread = (x.rowwise() - x.colwise().mean()).squaredNorm();
    return spread > 0.0 ? steps / (2.0 * spread) : 1.0;
  }
  return 1.0;
}

bool is_list_of_poses(const Recording& recording, double step, const std::string& file) {
  if (step < kPoses) return false;
  const double dense = 1.0 - elementary::cos(2.0 * std::numbers::pi / kRowsPerPeriod);
  require(recording.samples() < 2 * kRowsPerPeriod || step_ratio(recording) > dense, Exit::kData,
          file, ": the median step of column 't' is ", step,
          " s, but from row to row the orientation hardly changes: write t in seconds, or keep one "
          "row of each pose at rest");
  return true;
}

}  // namespace

bool is_gap(double step, double dt) { return step > (kGap + kOff) * dt; }

StepCount count_steps(const Eigen::VectorXd& t, double median, double most_off) {
  StepCount count;
  for (Index i = 1; i < t.size(); ++i) {
    const double step = (t[i] - t[i - 1]) / median, whole = std::max(1.0, std::round(step));
    if (is_gap(step, 1.0) || std::abs(step - whole) > most_off) continue;
    count.time += step;
    count.ticks += whole;
  }
  return count;
}

std::optional<double> step_of_rounded(const Eigen::VectorXd& t) {
  constexpr Index kFewestRows = 20;
  const Index n = t.size();
  if (n < kFewestRows) return std::nullopt;
  // Least squares of a line over the rows' places.
  const double half = 0.5 * static_cast<double>(n - 1);
  const Eigen::ArrayXd place = Eigen::ArrayXd::LinSpaced(n, -half, half);
  const Eigen::ArrayXd about = t.array() - t.mean();
  const double step = (about * place).sum() / place.square().sum();
  const Eigen::ArrayXd steps = (t.tail(n - 1) - t.head(n - 1)).array();
  if (!((steps - step).abs().maxCoeff() > kOff * step)) return std::nullopt;
  // Numbers that are written with so many digits in all have the fewest decimals where they are
  // large: at the end.
  constexpr double kHalf = 0.55;  // of the digit, and a little for the line's own error
  const double digit = last_digit(t.tail(n / 10));
  const bool is_even = (about - step * place).abs().maxCoeff() <= kHalf * digit;
  return is_even ? std::optional(step) : std::nullopt;
}

std::vector<Segment> split_at_gaps(const Eigen::VectorXd& t, const std::vector<Segment>& stretches,
                                   double dt) {
  std::vector<Segment> segments;
  for (const Segment& stretch : stretches) {
    segments.push_back(stretch);
    for (Index i = stretch.begin + 1; i < stretch.end; ++i) {
      if (!is_gap(t[i] - t[i - 1], dt)) continue;
      segments.back().end = i;
      segments.push_back({i, stretch.end});
    }
  }
  return segments;
}

void set_clock(Recording& recording, const std::string& file, bool poses) {
  recording.segments = {{0, recording.samples()}};
  if (!recording.has("t")) return;
  Eigen::VectorXd t = recording.column("t");
  if (const auto step = step_of_rounded(t)) {
    const Index n = t.size();
    t = t[0] + *step * Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
    recording.set("t", t);
    std::ostringstream note;
    note << "stamps have few digits: put on the even clock of " << 1.0 / *step
         << " Hz that they show";
    recording.notes.push_back(note.str());
  }
  check_increasing(t, file);
  if (t[0] > kEpoch) {
    recording.clock_origin = t[0];
    t.array() -= t[0];
    recording.set("t", t);
    recording.notes.push_back("clock origin subtracted from t");
  }
  recording.dt = median_step(t);
  require(recording.dt > 0.0, Exit::kData, file,
          ": has one sample in time; record for longer, or leave out t for a list of static poses");
  if (poses && is_list_of_poses(recording, recording.dt, file)) {
    recording.dt = 0.0;
    recording.notes.push_back("rows a second or more apart: poses at rest, nothing between them");
    return;
  }
  require(recording.dt < kSlowestStep, Exit::kData, file, ": the median step of column 't' is ",
          recording.dt, " s; write t in seconds");
  require(recording.dt >= kFastestStep, Exit::kData, file, ": the median step of column 't' is ",
          recording.dt, " s, faster than any sensor; write t in seconds");
  recording.dt = step_of(t, recording.dt);
  recording.segments = split_at_gaps(t, recording.segments, recording.dt);
  if (recording.segments.size() > 1)
    recording.notes.push_back(words_of_gaps(t, recording.segments));
}

void check_regular(Recording& recording, const std::string& file) {
  if (recording.dt == 0.0) return;
  const Eigen::VectorXd t = recording.column("t");
  Index off = 0, steps = 0, first = 0, lost = 0;
  for (const Segment& segment : recording.segments) {
    for (Index i = segment.begin + 1; i < segment.end; ++i, ++steps) {
      const double ticks = (t[i] - t[i - 1]) / recording.dt;
      // The smallest of margins: a clock written with few digits may sit exactly on the limit.
      if (std::abs(ticks - 1.0) <= kOff + 1e-9) continue;
      if (ticks > 1.5 && std::abs(ticks - std::round(ticks)) <= kOff + 1e-9) {
        lost += std::llround(ticks) - 1;
        continue;
      }
      if (off++ == 0) first = i;
    }
  }
  if (static_cast<double>(lost) > kMostLost * static_cast<double>(steps)) off += lost;
  require(static_cast<double>(off) <= kTolerated * static_cast<double>(steps), Exit::kData,
          place(file, first), ": irregular clock: ", off, " of ", steps,
          " steps are off by more than 20 % of the median ", recording.dt, " s; use --resample",
          recording.dt < kPoses ? "" : ", or leave column 't' out of a list of poses at rest");
  if (lost == 0) return;
  std::ostringstream note;
  note << lost << " rows are lost, at most " << kGap - 1.0
       << " in a row: derivatives bridge them by a cubic spline";
  recording.notes.push_back(note.str());
}

void drop_short_stretches(Recording& recording, Index least) {
  if (recording.dt == 0.0) return;
  std::vector<bool> kept(static_cast<std::size_t>(recording.samples()), false);
  Index dropped = recording.samples();
  for (const Segment& segment : recording.segments) {
    if (segment.size() < least) continue;
    dropped -= segment.size();
    std::fill(kept.begin() + segment.begin, kept.begin() + segment.end, true);
  }
  // Too short as a whole: who needs derivatives says so.
  if (dropped == 0 || dropped == recording.samples()) return;
  keep_rows(recording, kept);
  recording.notes.push_back(std::to_string(dropped) + " rows in stretches shorter than " +
                            std::to_string(least) + " rows between gaps: left out");
}

}  // namespace dcnn
