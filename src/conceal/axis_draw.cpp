// SPDX-License-Identifier: Apache-2.0
#include "conceal/axis_draw.h"

#include <algorithm>
#include <cmath>

#include "conceal/laws.h"
#include "core/elementary.h"
#include "dcnn/conceal/axis.h"
#include "dcnn/core/error.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kMargin = 0.5;       // s, of motion before the first row and after the last
constexpr double kMostRows = 4e4;     // of all recordings
constexpr double kNearEnough = 1.5;   // times what was asked, either way
constexpr double kLeastOracle = 0.2;  // of the noise

/// Paths of recordings one after the other on one clock, the last one held out.
std::vector<AxisPath> draw_axis_paths(AxisScenario& s, const std::vector<std::string>& effects,
                                      Rng& rng) {
  const auto count = 2 + static_cast<std::size_t>(rng.below(4));
  std::vector<double> seconds;
  double rows = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double least = std::min(20.0, std::max(4.0, 2.0 / s.body.hz));
    seconds.push_back(logarithmic(rng, least, 40.0));
    rows += seconds.back() * s.log.hz;
  }
  while (rows > kMostRows) {
    for (double& each : seconds) each *= 0.7;
    rows *= 0.7;
  }
  const bool other_kind = rng.uniform() < 0.3;
  std::vector<AxisPath> paths;
  double clock = rng.uniform() < 0.5 ? 0.0 : rng.uniform(0.0, 20.0);
  for (std::size_t k = 0; k < count; ++k) {
    AxisRecording r;
    r.holdout = k + 1 == count;
    r.name = r.holdout ? "holdout_0" : "fit_" + std::to_string(k);
    r.motion = s.motion;
    for (int trial = 0; trial < 20 && r.holdout && other_kind; ++trial) {
      const std::string kind = one_of(rng, axis_motions());
      const bool told = std::all_of(effects.begin(), effects.end(), [&](const auto& e) {
        return can_be_told(e, s.form, kind, s.resting);
      });
      if (told && (kind == "one_way") == (s.motion == "one_way")) r.motion = kind;
    }
    AxisPath path;
    path.per_row = s.log.hz <= 500.0 ? 16 : 8;
    path.step = 1.0 / (s.log.hz * static_cast<double>(path.per_row));
    path.rows = static_cast<Index>(seconds[k] * s.log.hz);
    path.before = static_cast<Index>(std::ceil(kMargin * s.log.hz)) * path.per_row;
    path.start = clock - static_cast<double>(path.before) * path.step;
    make_axis_motion(r.motion, s.body, s.resting, path.rows * path.per_row + 2 * path.before, path,
                     rng);
    s.span = clock + seconds[k];
    clock = std::ceil(s.span + rng.uniform(2.0, 20.0));
    paths.push_back(std::move(path));
    s.recordings.push_back(std::move(r));
  }
  return paths;
}

/// Rows of the recordings to fit on, of what the axis shows with these effects alone.
class AxisChange {
 public:
  AxisChange(const AxisScenario& s, const std::vector<AxisPath>& fitted)
      : body_(s.body), fitted_(fitted) {
    for (const AxisPath& path : fitted) plain_.push_back(shown(path, {}));
  }
  double operator()(const Hidden& h) const {
    double square = 0.0, rows = 0.0;
    for (std::size_t k = 0; k < fitted_.size(); ++k) {
      square += (shown(fitted_[k], {h}) - plain_[k]).squaredNorm();
      rows += static_cast<double>(fitted_[k].rows);
    }
    return std::sqrt(square / rows);
  }

 private:
  VectorXd shown(const AxisPath& path, const std::vector<Hidden>& hidden) const {
    Eigen::MatrixXd rows = path.logged(axis_effort(body_, path, hidden));
    std::vector<Hidden> digital = hidden;
    for (Hidden& h : digital) h.axis = "sensor_x";
    digitise(digital, rows);
    return rows;
  }
  const AxisBody& body_;
  const std::vector<AxisPath>& fitted_;
  std::vector<VectorXd> plain_;
};

/// The effect as strong as `target` [unit], or as it may become; nothing where it changes nothing.
std::optional<Hidden> as_strong(const AxisScenario& s, const AxisChange& change, Hidden h,
                                double target) {
  if (h.effect == "saturation") {  // it acts from its limit down
    double low = 0.0, high = 20.0 * s.body.effort;
    for (int k = 0; k < 30; ++k) {
      h.parameters["limit_n"] = 0.5 * (low + high);
      (change(h) > target ? low : high) = h.parameters["limit_n"];
    }
    h.parameters["limit_n"] = high;
  }
  double now = change(h);
  if (!(now > 1e-9 * s.body.effort)) return std::nullopt;
  // Secant steps through the origin: exact at once for what is linear.
  for (int k = 0; k < 5 && std::abs(now / target - 1.0) > 0.01 && h.effect != "saturation"; ++k) {
    h = stronger(h, s.body, target / now);
    now = change(h);
  }
  h.amplitude = now / s.log.sigma;
  return h;
}

/// The simulated column is in another unit: its scale is a gain that the report must name.
void set_scale(AxisScenario& s, const std::vector<AxisPath>& fitted, Rng& rng) {
  s.scale = logarithmic(rng, 0.05, 20.0);
  double square = 0.0, rows = 0.0;
  for (const AxisPath& path : fitted) {
    square += path.logged(rigid_effort(s.body, path)).squaredNorm();
    rows += static_cast<double>(path.rows);
  }
  Hidden h;
  h.effect = "gain";
  h.parameters = {{"gain_x", s.scale - 1.0}};
  h.amplitude = std::abs(1.0 - 1.0 / s.scale) * std::sqrt(square / rows) / s.log.sigma;
  s.hidden.push_back(h);
}

/// The bits of a reading whose step is 0.4 deviations of the noise, 8 to 16.
void set_digit(AxisLogging& log, double largest) {
  double step = 2.0 * largest / 256.0;
  for (int bits = 8; bits < 16 && step > 0.4 * log.sigma; ++bits) step /= 2.0;
  log.digit = step;
}

/// Form of the simulator and kind of motion with which all the effects can be told.
bool draw_axis_setting(const AxisRequest& request, AxisScenario& s, Rng& rng) {
  const double form = rng.uniform();
  s.form =
      request.group == "scaled" || form < 0.5 ? "simulated" : (form < 0.87 ? "base" : "constant");
  s.motion = one_of(rng, axis_motions());
  s.resting = rng.uniform() < 0.4 ? 0.0 : rng.uniform(0.1, 0.8);
  return std::all_of(request.effects.begin(), request.effects.end(), [&](const std::string& e) {
    return can_be_told(e, s.form, s.motion, s.resting);
  });
}

/// Terms of the rigid body that a fitted simulator must not have, for they are hidden.
std::string left_out_of(const AxisRequest& request, const std::string& form) {
  std::string list;
  for (const std::string& e : request.effects) {
    if (form == "base" && e == "viscous_friction") list += " viscous";
    if (form == "base" && e == "cable_spring") list += " stiffness";
    if (form == "base" && e == "gravity_load") list += " gravity";
  }
  return list;
}

/// Nothing where an effect changes nothing, or cannot become as strong as asked.
std::optional<AxisScenario> axis_attempt(const std::string& id, const AxisRequest& request,
                                         Rng rng) {
  AxisScenario s;
  s.id = id;
  s.group = request.group;
  if (!draw_axis_setting(request, s, rng)) return std::nullopt;
  s.body = draw_axis_body(request.effects, rng);
  if (s.motion == "one_way" && s.body.turn <= 0.0) return std::nullopt;
  s.name = s.body.kind;
  s.log = draw_axis_logging(s.body, s.form, rng);
  const std::vector<AxisPath> paths = draw_axis_paths(s, request.effects, rng);
  const std::vector<AxisPath> fitted(paths.begin(), paths.end() - 1);
  set_rigid(s.body, s.form, left_out_of(request, s.form), fitted, rng);
  s.log.sigma = logarithmic(rng, 0.003, 0.1) * s.body.effort;
  const AxisChange change(s, fitted);
  for (const std::string& e : request.effects) {
    Hidden h = draw_axis_effect(e, s.body, rng);
    h.axis = s.name;
    if (e == "step_bias") {
      const AxisPath& first = fitted.front();
      const double seconds = static_cast<double>(first.rows) / s.log.hz;
      h.interval_s = {first.time(first.before) + seconds * rng.uniform(0.25, 0.75), s.span};
    }
    const double target = request.from * elementary::pow(10.0, 0.5 * rng.uniform()) * s.log.sigma;
    const auto strong = as_strong(s, change, h, target);
    if (!strong) return std::nullopt;
    const double ratio = strong->amplitude * s.log.sigma / target;
    if (ratio > kNearEnough || ratio < 1.0 / kNearEnough) return std::nullopt;
    s.hidden.push_back(*strong);
  }
  double largest = 0.0;
  std::vector<VectorXd> signals;
  for (const AxisPath& path : paths) {
    signals.push_back(axis_effort(s.body, path, s.hidden));
    largest = std::max(largest, signals.back().cwiseAbs().maxCoeff());
  }
  if (request.group == "scaled") set_scale(s, fitted, rng);
  if (s.log.noise == "quantised") set_digit(s.log, 1.2 * largest);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    log_axis(s, paths[k], signals[k], s.recordings[k], rng);
  }
  for (Hidden& h : s.hidden) h.axis = s.name;
  // Clipped all the time the held-out recording tells nothing.
  if (axis_oracle(s) < kLeastOracle * s.log.sigma) return std::nullopt;
  return s;
}

}  // namespace

AxisScenario draw_axis_scenario(const std::string& id, std::uint64_t seed) {
  constexpr std::uint64_t kTrials = 400;
  const AxisRequest request = parse_axis_id(id);
  std::uint64_t name = 1469598103934665603ULL;  // FNV-1a
  for (const char c : id) name = (name ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  for (std::uint64_t k = 0; k < kTrials; ++k) {
    if (auto made = axis_attempt(id, request, Rng({seed, 31, name, k}))) return *std::move(made);
  }
  fail(Exit::kUsage, id, ": in ", kTrials, " machines of seed ", seed,
       " these effects are never as strong as asked; give another seed");
}

}  // namespace dcnn::conceal
