// SPDX-License-Identifier: Apache-2.0
// What the drive of an axis logs: an encoder, a noisy effort, a clock that is not perfect.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conceal/axis_draw.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// To nine digits of a number as large as `scale`, in decimals.
VectorXd nine_digits(const VectorXd& x, double scale) {
  double unit = 1.0;
  while (scale * unit < 1e8) unit *= 10.0;
  return x.unaryExpr([=](double value) { return std::round(value * unit) / unit; });
}

/// Deviations of the effort's noise, of mean square 1.
VectorXd noise_of(const AxisScenario& s, const VectorXd& clean, Rng& rng) {
  const AxisLogging& log = s.log;
  VectorXd noise(clean.size());
  double at = rng.normal();
  const double usual = std::sqrt(clean.squaredNorm() / static_cast<double>(clean.size()));
  for (Index i = 0; i < noise.size(); ++i) {
    at = log.keep * at + std::sqrt(1.0 - log.keep * log.keep) * rng.normal();
    // 0.3 of it always, the rest with the size of the effort: mean square about 1.
    const double load = usual > 0.0 ? std::abs(clean(i)) / usual : 1.0;
    noise(i) = log.noise == "load" ? at * std::sqrt(0.3 * 0.3 + 0.91 * load * load) : at;
  }
  return log.sigma * noise;
}

VectorXd encoded(const AxisLogging& log, const VectorXd& q, double reach, Rng& rng) {
  if (log.counts) {
    return q.unaryExpr([&](double x) { return std::round(x / log.encoder) * log.encoder; });
  }
  VectorXd read = q;
  for (double& x : read) x += log.encoder * rng.normal();
  return nine_digits(read, reach);
}

/// Differences of the encoder's position through a first-order low-pass, as a controller has them.
VectorXd controller_velocity(const AxisLogging& log, const VectorXd& q) {
  const double keep = elementary::exp(-2.0 * std::numbers::pi * log.velocity_hz / log.hz);
  VectorXd v = VectorXd::Zero(q.size());
  for (Index i = 1; i < q.size(); ++i) {
    v(i) = keep * v(i - 1) + (1.0 - keep) * (q(i) - q(i - 1)) * log.hz;
  }
  v(0) = v(std::min<Index>(1, v.size() - 1));
  return v;
}

/// Rows that are there: gaps of one to three rows make up the share that is lost.
std::vector<Index> rows_kept(const AxisLogging& log, Index rows, Rng& rng) {
  std::vector<Index> kept;
  for (Index i = 0; i < rows; ++i) {
    if (i > 0 && rng.uniform() < 0.5 * log.lost) i += 1 + static_cast<Index>(rng.below(3));
    if (i < rows) kept.push_back(i);
  }
  return kept;
}

}  // namespace

AxisLogging draw_axis_logging(const AxisBody& body, const std::string& form, Rng& rng) {
  AxisLogging log;
  std::vector<double> rates;
  for (const double hz : {50.0, 100.0, 125.0, 200.0, 250.0, 400.0, 500.0, 1000.0, 2000.0}) {
    if (hz >= 60.0 * body.hz) rates.push_back(hz);
  }
  log.hz = one_of(rng, rates);
  // 10^3 to 10^6 counts a turn, 500 in the range at least; a slide's as fine in its range.
  const double whole = body.turn > 0.0 ? body.turn : 2.0 * body.reach;
  log.encoder = std::min(whole / std::round(logarithmic(rng, 1e3, 1e6)), body.reach / 250.0);
  log.counts = rng.uniform() < 0.6;
  if (!log.counts) log.encoder *= 0.3;
  if (rng.uniform() < 0.33) {
    log.velocity_hz =
        std::min(log.hz / 6.0, std::max(20.0 * body.hz, logarithmic(rng, 20.0, 100.0)));
  }
  if (rng.uniform() < 0.3) log.jitter = rng.uniform(0.005, 0.05);
  if (rng.uniform() < 0.3) log.lost = logarithmic(rng, 0.0005, 0.005);
  if (rng.uniform() < 0.1) log.held = 2;
  if (form == "simulated" && rng.uniform() < 0.08) {
    log.filter_s = std::min(logarithmic(rng, 0.5, 3.0) / log.hz, 0.01 / body.hz);
  } else if (rng.uniform() < 0.08) {
    log.lowpass_hz = std::round(std::max(16.0 * body.hz, rng.uniform(0.15, 0.3) * log.hz));
    log.jitter = log.lost = 0.0, log.held = 1;
  }
  log.noise = one_of<std::string>(rng, {"white", "ar1", "load", "quantised"});
  if (log.noise == "ar1") log.keep = rng.uniform(0.4, 0.9);
  return log;
}

void log_axis(const AxisScenario& s, const AxisPath& path, const VectorXd& signal, AxisRecording& r,
              Rng& rng) {
  const AxisLogging& log = s.log;
  const Index rows = path.rows;
  Eigen::MatrixXd clean = path.logged(lagged(path, signal, log.filter_s));
  Eigen::MatrixXd read = clean + noise_of(s, clean, rng);
  if (log.digit > 0.0) read = (read / log.digit).array().round().matrix() * log.digit;
  std::vector<Hidden> digital;
  for (Hidden h : s.hidden) {
    h.axis = "sensor_x";
    digital.push_back(h);
  }
  digitise(digital, clean);
  digitise(digital, read);
  const VectorXd position = encoded(log, path.logged(path.q), s.body.reach, rng);
  const VectorXd velocity =
      log.velocity_hz > 0.0 ? controller_velocity(log, position) : VectorXd::Zero(rows);
  const VectorXd rigid = lagged(path, rigid_effort(s.body, path), log.filter_s) / s.scale;
  const VectorXd simulated = path.logged(rigid);
  const std::vector<Index> kept = rows_kept(log, rows, rng);
  const auto n = static_cast<Index>(kept.size());
  r.fresh.clear();
  r.t = r.q = r.measured = r.clean = r.simulated = r.velocity = VectorXd::Zero(n);
  for (Index i = 0; i < n; ++i) {
    const Index k = kept[static_cast<std::size_t>(i)], source = k - k % log.held;
    r.fresh.push_back(source == k);
    r.t(i) = path.time(path.before + k * path.per_row) + log.jitter * rng.normal() / log.hz;
    r.q(i) = position(k), r.velocity(i) = velocity(k);
    r.measured(i) = read(source, 0), r.clean(i) = clean(source, 0), r.simulated(i) = simulated(k);
  }
  r.t = r.t.unaryExpr([](double t) { return std::round(t * 1e7) / 1e7; });
  r.simulated = nine_digits(r.simulated, s.body.effort / s.scale);
  r.velocity = nine_digits(r.velocity, s.body.fast);
  if (log.velocity_hz <= 0.0) r.velocity.resize(0);
  const bool on_lattice =
      log.digit > 0.0 || std::any_of(s.hidden.begin(), s.hidden.end(),
                                     [](auto& h) { return h.effect == "quantisation"; });
  if (!on_lattice) r.measured = nine_digits(r.measured, s.body.effort);
}

}  // namespace dcnn::conceal
