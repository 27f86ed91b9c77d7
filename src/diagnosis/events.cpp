// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/events.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/evidence/priors.h"
#include "diagnosis/sample_at.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr double kFinestGrid = 0.25;  // s, of the exhaustive search; a cell holds a sample

/// Whitened residual summed over cells of time, in the sensor's axes and in the base's.
struct Cells {
  double grid = 0.0;      // s, their length
  std::vector<double> t;  // beginning of each
  std::vector<std::size_t> log;
  Eigen::MatrixXd sum;     // (cells, channels), of residual·weight
  Eigen::VectorXd weight;  // (cells) number of blocks
};

/// Adds the cells of a recording: none lie in a gap longer than an event.
void add_cells(const Motion& motion, std::size_t log, Cells& cells) {
  double t = motion.t(0);
  for (std::size_t s = 0; s < motion.segments.size(); ++s) {
    const double first = motion.t(motion.segments[s].begin);
    if (first - t > prior::kLongestEvent) t += cells.grid * std::floor((first - t) / cells.grid);
    for (const double end = motion.t(motion.segments[s].end - 1); t <= end; t += cells.grid) {
      cells.t.push_back(t);
      cells.log.push_back(log);
    }
  }
}

Cells make_cells(const Scan& scan, bool in_base) {
  const Case& study = scan.setting().study;
  const Whitener& whitener = scan.setting().whitener;
  // Back from whitened to a residual in units of the block's noise: sums over cells of a second or
  // so change little, and the exact gain is computed afterwards.
  const auto& info = whitener.row_info();
  const Index channels = study.channel_count();
  Cells cells;
  cells.grid = std::max(kFinestGrid, study.dt());
  std::vector<std::size_t> first_cell;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    first_cell.push_back(cells.t.size());
    add_cells(study.logs[k].motion, k, cells);
  }
  first_cell.push_back(cells.t.size());
  /// The last cell of a recording that begins at or before a time.
  const auto cell_of = [&](std::size_t log, double t) {
    const auto begin = cells.t.begin() + static_cast<Index>(first_cell[log]);
    const auto end = cells.t.begin() + static_cast<Index>(first_cell[log + 1]);
    return std::max<Index>(0, std::upper_bound(begin, end, t) - cells.t.begin() - 1);
  };
  cells.sum.setZero(static_cast<Index>(cells.t.size()), channels);
  cells.weight.setZero(static_cast<Index>(cells.t.size()));
  const Eigen::VectorXd& r = scan.residual();
  for (Index row = 0; row < r.size(); ++row) {
    const auto& at = info[static_cast<std::size_t>(row)];
    const auto& motion = study.logs[at.log].motion;
    const Index cell = cell_of(at.log, at.t);
    const double value = r(row) * scan.setting().mask(row);
    if (at.channel == 0) cells.weight(cell) += scan.setting().mask(row);
    if (!in_base || study.channels[at.channel] > 2) {
      cells.sum(cell, at.channel) += value;
      continue;
    }
    const Index sample = sample_at(motion, at.t);
    const Eigen::Matrix3d& R = motion.R_BS[static_cast<std::size_t>(sample)];
    for (Index j = 0; j < std::min<Index>(3, channels); ++j) {
      cells.sum(cell, j) += R(j, study.channels[at.channel]) * value;
    }
  }
  return cells;
}

struct Stretch {
  double begin = 0.0, end = 0.0, gain = 0.0;
  std::size_t log = 0;
};

/// The interval of least chi-square in one pass over all pairs of cells, apart from `taken`.
Stretch best_span(const Cells& cells, const Stretch* taken) {
  Stretch best;
  const auto n = static_cast<Index>(cells.t.size());
  std::map<std::size_t, Index> length;
  for (const std::size_t log : cells.log) ++length[log];
  for (Index a = 0; a < n; ++a) {
    const auto part = prior::kMostOfRecording *
                      static_cast<double>(length[cells.log[static_cast<std::size_t>(a)]]);
    const auto longest = static_cast<Index>(std::min(prior::kLongestEvent / cells.grid, part));
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(cells.sum.cols());
    double weight = 0.0;
    for (Index b = a; b < std::min(n, a + longest); ++b) {
      if (cells.log[static_cast<std::size_t>(b)] != cells.log[static_cast<std::size_t>(a)]) break;
      const double begin = cells.t[static_cast<std::size_t>(a)];
      const double end = cells.t[static_cast<std::size_t>(b)] + cells.grid;
      if (end - begin > prior::kLongestEvent + cells.grid) break;
      const bool overlaps = taken && taken->log == cells.log[static_cast<std::size_t>(a)] &&
                            begin < taken->end + 0.5 && end > taken->begin - 0.5;
      if (overlaps) break;
      sum += cells.sum.row(b).transpose();
      weight += cells.weight(b);
      if (weight < 8.0) continue;
      const double gain = sum.squaredNorm() / weight;
      if (gain > best.gain) best = {begin, end, gain, cells.log[static_cast<std::size_t>(a)]};
    }
  }
  return best;
}

Member contact_member(const Case& study, const Stretch& span) {
  const EffectKind& kind = *find_effect("contact");
  Member member = make_member(study, kind, kind.fits[0], "", Eigen::VectorXd(0));
  member.interval_s = {span.begin, std::max(span.begin + 0.02, span.end)};
  if (!study.shared_clock) member.recording = study.logs[span.log].motion.recording;
  return member;
}

}  // namespace

Trial find_contact(const Scan& scan) {
  const Case& study = scan.setting().study;
  const Cells cells = make_cells(scan, true);
  const Stretch first = best_span(cells, nullptr);
  Trial best;
  if (first.gain < 60.0) return best;
  best = scan.evaluate(contact_member(study, first));
  const auto loss = [&](const Eigen::VectorXd& ends) {
    const auto& t = study.logs[first.log].motion.t;
    const double whole = t(t.size() - 1) - t(0), length = ends(1) - ends(0);
    if (length < 0.05 || length > prior::kMostOfRecording * whole) return 0.0;
    if (ends(0) < t(0) - cells.grid || ends(1) > t(t.size() - 1) + cells.grid) return 0.0;
    Stretch span = first;
    span.begin = ends(0);
    span.end = ends(1);
    const Trial trial = scan.evaluate(contact_member(study, span));
    if (trial.gain > best.gain) best = trial;
    return -trial.gain;
  };
  for (const double size : {0.2, 0.03}) {
    const auto [begin, end] = *best.member.interval_s;
    simplex_search(loss, Eigen::Vector2d(begin, end), Eigen::Vector2d(size, -size), 24);
  }
  // A second interval nearly as good: this is no single event.
  Stretch taken = first;
  taken.begin = best.member.interval_s->first;
  taken.end = best.member.interval_s->second;
  const Stretch second = best_span(cells, &taken);
  if (second.gain > 0.5 * first.gain) best.gain = 0.0;
  return best;
}

Trial find_step(const Scan& scan) {
  const Case& study = scan.setting().study;
  const EffectKind& kind = *find_effect("step_bias");
  Trial best;
  const auto member_at = [&](double t, std::size_t log) {
    Member member = make_member(study, kind, kind.fits[0], "", Eigen::VectorXd(0));
    member.interval_s = {t, study.end_of_clock};
    if (!study.shared_clock) {
      const auto& motion = study.logs[log].motion;
      member.interval_s->second = motion.t(motion.samples() - 1);
      member.recording = motion.recording;
    }
    return member;
  };
  // Coarse: the change of the running mean of the residual, every 0.25 s.
  const Cells cells = make_cells(scan, false);
  const auto n = static_cast<Index>(cells.t.size());
  double end_of_fit = -kInfinity;
  for (const Log& log : study.logs) {
    end_of_fit = std::max(end_of_fit, log.motion.t(log.motion.samples() - 1));
  }
  std::vector<std::pair<double, Index>> ranked;
  Eigen::VectorXd total = cells.sum.colwise().sum();
  const double all = cells.weight.sum();
  Eigen::VectorXd before = Eigen::VectorXd::Zero(cells.sum.cols());
  double weight = 0.0;
  for (Index c = 0; c < n; ++c) {
    const auto& motion = study.logs[cells.log[static_cast<std::size_t>(c)]].motion;
    const double t = cells.t[static_cast<std::size_t>(c)];
    const double first = study.shared_clock ? study.logs.front().motion.t(0) : motion.t(0);
    const double last = study.shared_clock ? end_of_fit : motion.t(motion.samples() - 1);
    const double rest = all - weight;
    if (t > first + prior::kStepEnds && t < last - prior::kStepEnds && weight > 0.0 && rest > 0.0) {
      const double gain =
          (before / weight - (total - before) / rest).squaredNorm() * weight * rest / all;
      ranked.emplace_back(std::max(gain, (total - before).squaredNorm() / rest), c);
    }
    before += cells.sum.row(c).transpose();
    weight += cells.weight(c);
  }
  std::sort(ranked.rbegin(), ranked.rend());
  for (std::size_t k = 0; k < std::min<std::size_t>(6, ranked.size()); ++k) {
    const auto cell = static_cast<std::size_t>(ranked[k].second);
    const Trial trial = scan.evaluate(member_at(cells.t[cell], cells.log[cell]));
    if (trial.gain > best.gain) best = trial;
  }
  if (best.gain < 40.0) return Trial();
  std::size_t log = 0;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    if (study.logs[k].motion.t(0) <= best.member.interval_s->first) log = k;
  }
  const auto loss = [&](const Eigen::VectorXd& t) {
    const Trial trial = scan.evaluate(member_at(t(0), log));
    if (trial.gain > best.gain) best = trial;
    return -trial.gain;
  };
  for (const double size : {0.5, 0.1, 0.02}) {
    simplex_search(loss, Eigen::VectorXd::Constant(1, best.member.interval_s->first),
                   Eigen::VectorXd::Constant(1, size), 12);
  }
  return best;
}

}  // namespace dcnn
