// SPDX-License-Identifier: Apache-2.0
#include "identification/wrist_log.h"

#include <algorithm>
#include <cmath>

#include "dcnn/data/filter.h"
#include "dcnn/data/fourier.h"

namespace dcnn::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRestStep = 0.2;  // s between rows: a robot's motion has faster parts than 2.5 Hz
constexpr double kMotionPower = 0.999;  // share of the rates' power that counts as motion
constexpr double kLowestCutoff = 2.0, kHighestCutoff = 15.0;  // Hz: arms with a tool move below
constexpr double kRowsPerCycle = 2.5;  // of the cutoff: above Nyquist's 2 for the filter's slope
constexpr double kWider = 3.0;         // times the cutoff: the band of the derivatives
constexpr double kEdge = 0.5;          // cycles of the cutoff at the ends of a segment
const std::vector<std::string> kForces{"fx", "fy", "fz"}, kTorques{"tx", "ty", "tz"};

double median_step_of(const Table& table) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), "t");
  const Index rows = table.values.rows();
  if (found == table.columns.end() || rows < 2) return 0.0;
  const VectorXd t = table.values.col(found - table.columns.begin());
  VectorXd steps = t.tail(rows - 1) - t.head(rows - 1);
  std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
  return steps[steps.size() / 2];
}

/// The frequency below which kMotionPower of a rate's power lies, mean of its components removed.
double band_of(const MatrixXd& rates, const WristLog& log) {
  const auto longest =
      std::max_element(log.motion.segments.begin(), log.motion.segments.end(),
                       [](const Segment& a, const Segment& b) { return a.size() < b.size(); });
  const Index n = longest->size();
  const Index length = fast_length(n);
  const Fourier transform(length);
  VectorXd power = VectorXd::Zero(length / 2 + 1);
  for (Index k = 0; k < rates.cols(); ++k) {
    VectorXd x = VectorXd::Zero(length);
    x.head(n) = rates.col(k).segment(longest->begin, n);
    x.head(n).array() -= x.head(n).mean();
    for (Index i = 0; i < n; ++i) {  // Hann: a step between the ends is no motion
      x[i] *= std::pow(std::sin(M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(n)), 2);
    }
    power += transform(x).cwiseAbs2();
  }
  const double total = power.sum();
  double sum = 0.0;
  Index bin = 0;
  while (bin + 1 < power.size() && sum < kMotionPower * total) sum += power[bin++];
  return static_cast<double>(bin) / (static_cast<double>(length) * log.recording.dt);
}

double cutoff_of(const WristLog& log) {
  const double rate = 1.0 / log.recording.dt;
  double band = band_of(log.motion.w_S, log);
  if (log.motion.v_B.rows() > 0) band = std::max(band, band_of(log.motion.v_B, log));
  const double highest = std::min(kHighestCutoff, rate / (2.0 * kRowsPerCycle));
  return std::clamp(2.0 * band, std::min(kLowestCutoff, highest), highest);
}

DerivativeSpec derivative_of(double cutoff_hz) {
  DerivativeSpec spec;
  spec.kind = DerivativeSpec::Kind::kSpectral;
  spec.cutoff_hz = cutoff_hz;
  return spec;
}

void set_motion(WristLog& log) {
  Recording& recording = log.recording;
  log.accelerated = recording.has_all(kPosition) || recording.has_all({"ax", "ay", "az"}) ||
                    recording.has_all({"vx", "vy", "vz"});
  const double nyquist = 0.5 / recording.dt;
  const auto within = [&](double hz) { return derivative_of(std::min(hz, 0.8 * nyquist)); };
  log.motion = motion_of(recording, ToolModel(), within(kHighestCutoff));
  log.cutoff_hz = cutoff_of(log);
  log.motion = motion_of(recording, ToolModel(), within(kWider * log.cutoff_hz));
  thin(log);
}

WristLog read_log(const std::filesystem::path& path, ReadOptions options) {
  WristLog log;
  SourceTable source = read_table(path);
  log.at_rest = is_at_rest(source.table);
  if (log.at_rest) {
    options.static_list = true;
    log.t = take_times(source.table);
  }
  log.recording = make_recording(std::move(source), path, options, System());
  require(log.recording.has_all(kForces), Exit::kData, path.string(),
          ":1: no measured force; a mass needs fx,fy,fz");
  if (!log.at_rest) {
    log.t = log.recording.column("t");
    set_motion(log);
    return log;
  }
  log.motion = motion_of(log.recording, ToolModel(), DerivativeSpec());
  keep_all(log);
  return log;
}

}  // namespace

bool is_at_rest(const Table& table) {
  const bool has_t = std::count(table.columns.begin(), table.columns.end(), "t") > 0;
  return !has_t || median_step_of(table) >= kRestStep;
}

VectorXd take_times(Table& table) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), "t");
  if (found == table.columns.end()) return VectorXd::Zero(table.values.rows());
  const Index k = found - table.columns.begin(), last = table.values.cols() - 1;
  const VectorXd t = table.values.col(k);
  MatrixXd rest(table.values.rows(), last);
  rest << table.values.leftCols(k), table.values.rightCols(last - k);
  table.values = rest;
  table.columns.erase(found);
  return t.size() > 0 ? VectorXd(t.array() - t[0]) : t;
}

void keep_all(WristLog& log) {
  for (Index k = 0; k < log.recording.samples(); ++k) {
    log.kept.push_back(k);
    log.segments.push_back({k, k + 1});
  }
}

// Every k-th row, without the ends of segments, which the filters do not know.
void thin(WristLog& log) {
  const double dt = log.recording.dt;
  const Index step = std::max<Index>(
      1, static_cast<Index>(std::floor(1.0 / (kRowsPerCycle * log.cutoff_hz * dt))));
  const auto edge = static_cast<Index>(std::ceil(kEdge / (log.cutoff_hz * dt)));
  log.kept.clear();
  log.segments.clear();
  for (const Segment& segment : log.motion.segments) {
    const auto begin = static_cast<Index>(log.kept.size());
    for (Index k = segment.begin + edge; k < segment.end - edge; k += step) log.kept.push_back(k);
    const auto end = static_cast<Index>(log.kept.size());
    if (end > begin) log.segments.push_back({begin, end});
  }
  require(!log.kept.empty(), Exit::kData, log.recording.name, ": too short: the motion's band of ",
          log.cutoff_hz, " Hz needs pieces of more than ", 2.0 * kEdge / log.cutoff_hz,
          " s; record for longer");
}

MatrixXd WristLog::thinned(const MatrixXd& signals) const {
  const MatrixXd smooth =
      cutoff_hz > 0.0 ? low_pass(signals, motion.segments, recording.dt, cutoff_hz) : signals;
  MatrixXd out(static_cast<Index>(kept.size()), signals.cols());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    out.row(static_cast<Index>(k)) = smooth.row(kept[k]);
  }
  return out;
}

double WristLog::rate_hz() const {
  if (at_rest || kept.size() < 2) return 0.0;
  return 1.0 / (recording.dt * static_cast<double>(kept[1] - kept[0]));
}

std::vector<WristLog> read_wrist_logs(const std::vector<std::filesystem::path>& paths,
                                      const ReadOptions& options) {
  std::vector<WristLog> logs;
  for (const auto& path : paths) logs.push_back(read_log(path, options));
  const bool torque = std::all_of(logs.begin(), logs.end(), [](const WristLog& log) {
    return log.recording.has_all(kTorques);
  });
  for (WristLog& log : logs) {
    std::vector<std::string> channels = kForces;
    if (torque) channels.insert(channels.end(), kTorques.begin(), kTorques.end());
    log.measured = log.recording.block(channels);
  }
  return logs;
}

void advance(WristLog& log, double seconds) {
  if (log.at_rest || seconds == 0.0) return;
  const double shift = seconds / log.recording.dt;
  const MatrixXd before = log.measured;
  for (const Segment& segment : log.motion.segments) {
    for (Index k = segment.begin; k < segment.end; ++k) {
      const double place =
          std::clamp(static_cast<double>(k) + shift, static_cast<double>(segment.begin),
                     static_cast<double>(segment.end - 1));
      const Index low = std::min(static_cast<Index>(place), segment.end - 1);
      const Index high = std::min(low + 1, segment.end - 1);
      const double part = place - static_cast<double>(low);
      log.measured.row(k) = (1.0 - part) * before.row(low) + part * before.row(high);
    }
  }
  log.delay_s += seconds;
}

}  // namespace dcnn::identification
