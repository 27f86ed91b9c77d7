// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "data/spectral.h"
#include "diagnosis/axis_case.h"
#include "physics/driven.h"
#include "physics/effect_law.h"

namespace dcnn {

Eigen::MatrixXd measured_part(const Case& study, const Wrench& wrench) {
  Eigen::MatrixXd part(wrench.force.rows(), study.channel_count());
  for (Index j = 0; j < study.channel_count(); ++j) {
    const int channel = study.channels[static_cast<std::size_t>(j)];
    part.col(j) = channel < 3 ? wrench.force.col(channel) : wrench.torque.col(channel - 3);
  }
  return part;
}

namespace {

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& all, const std::vector<Index>& rows) {
  return all.rows() == 0 ? all : Eigen::MatrixXd(all(rows, Eigen::all));
}

Motion thinned(const Motion& motion, Index stride) {
  Motion thin;
  thin.recording = motion.recording;
  thin.of_axis = motion.of_axis;
  thin.dt = motion.dt * static_cast<double>(stride);
  thin.has_clock = motion.has_clock;
  std::vector<Index> rows;
  for (const Segment& s : motion.segments) {
    const auto begin = static_cast<Index>(rows.size());
    for (Index k = s.begin + stride / 2; k < s.end; k += stride) rows.push_back(k);
    thin.segments.push_back({begin, static_cast<Index>(rows.size())});
  }
  thin.t = motion.t(rows);
  for (const Index k : rows) thin.R_BS.push_back(motion.R_BS[static_cast<std::size_t>(k)]);
  thin.euler = rows_of(motion.euler, rows);
  thin.p_B = rows_of(motion.p_B, rows);
  thin.v_B = rows_of(motion.v_B, rows);
  thin.a_B = rows_of(motion.a_B, rows);
  thin.w_S = rows_of(motion.w_S, rows);
  thin.dw_S = rows_of(motion.dw_S, rows);
  if (motion.temperature.size() > 0) thin.temperature = motion.temperature(rows);
  for (const LoggedSignal& signal : motion.signals) {
    thin.signals.push_back({signal.name, signal.values(rows)});
  }
  return thin;
}

}  // namespace

Case thinned(const Case& study, Index stride) {
  Case thin = study;
  thin.logs.clear();
  for (const Log& log : study.logs) {
    Log coarse;
    coarse.motion = thinned(log.motion, stride);
    std::vector<Index> rows;
    for (const Segment& s : log.motion.segments) {
      for (Index k = s.begin + stride / 2; k < s.end; k += stride) rows.push_back(k);
    }
    coarse.recording.name = log.recording.name;
    coarse.recording.table.values.resize(static_cast<Index>(rows.size()), 0);
    for (const char* name : {"x", "y", "z"}) {
      if (log.recording.has(name)) coarse.recording.set(name, log.recording.column(name)(rows));
    }
    coarse.base = {rows_of(log.base.force, rows), rows_of(log.base.torque, rows)};
    thin.logs.push_back(std::move(coarse));
  }
  // Beyond half of this rate a low-pass changes nothing that these rows show.
  if (thin.lowpass_hz > 0.0 && 2.0 * thin.lowpass_hz * thin.dt() >= 1.0) thin.lowpass_hz = 0.0;
  return thin;
}

Motion wrist_motion(const Log& log, const Case& study) {
  Motion motion = motion_of(log.recording, study.simulator.model, study.derivative);
  std::vector<std::string> names = signals_of(study.simulator.effects);
  for (const Case::Driver& driver : study.drivers) names.push_back(driver.signal);
  read_signals(log.recording, names, motion);
  return motion;
}

namespace {

void set_top_speeds(Case& study) {
  study.top_speed.clear();
  const Motion& first = study.logs.front().motion;
  if (study.is_static() || first.v_B.rows() != first.samples()) return;
  for (const std::string& axis : admitted_axes(AxisRule::kLine)) {
    double top = 0.0;
    for (const Log& log : study.logs) {
      top = std::max(top, velocity_of(axis, log.motion).cwiseAbs().maxCoeff());
    }
    study.top_speed[axis] = top;
  }
}

}  // namespace

void set_derivative(Case& study, const DerivativeSpec& derivative) {
  study.derivative = derivative;
  if (study.axis) {
    set_axis_motion(study);
  } else {
    for (Log& log : study.logs) log.motion = wrist_motion(log, study);
  }
  set_top_speeds(study);
}

bool has_own_offsets(const Case& study) {
  return std::all_of(study.logs.begin(), study.logs.end(),
                     [](const Log& log) { return log.zeroed; });
}

bool moves_fast(const Case& study) {
  return std::any_of(study.logs.begin(), study.logs.end(),
                     [](const Log& log) { return log.motion.is_fast; });
}

double end_seconds(const Case& study, double length) {
  const double begins = study.axis && moves_fast(study) ? 1.0 / study.derivative.cutoff_hz : 0.0;
  return std::min(kFlankSeconds + begins, 0.1 * length);
}

std::vector<Segment> inner_segments(const Case& study, std::size_t log) {
  std::vector<Segment> inner;
  for (const Segment& s : study.logs[log].motion.segments) {
    const double seconds = study.dt() * static_cast<double>(s.size());
    const Index end =
        study.is_static() ? 0 : std::llround(end_seconds(study, seconds) / study.dt());
    inner.push_back({s.begin + end, s.end - end});
  }
  return inner;
}

double mean_square(const Case& study, const std::vector<Eigen::MatrixXd>& left, Index channel) {
  double square = 0.0, rows = 0.0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    for (const Segment& s : inner_segments(study, k)) {
      square += left[k].col(channel).segment(s.begin, s.size()).squaredNorm();
      rows += static_cast<double>(s.size());
    }
  }
  return square / std::max(1.0, rows);
}

double longest_seconds(const Case& study) {
  double longest = 0.0;
  for (const Log& log : study.logs) {
    longest = std::max(longest, log.motion.dt * static_cast<double>(log.motion.samples()));
  }
  return longest;
}

double span_seconds(const Case& study) {
  if (!study.has_clock()) return 0.0;
  double begin = study.logs.front().motion.t(0), end = begin;
  for (const Log& log : study.logs) {
    begin = std::min(begin, log.motion.t(0));
    end = std::max(end, log.motion.t(log.motion.samples() - 1));
  }
  return end - begin;
}

}  // namespace dcnn
