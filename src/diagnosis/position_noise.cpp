// SPDX-License-Identifier: Apache-2.0
// What the noise of an axis' logged motion puts into the prediction: drawn, passed through filter
// and model, and read off as a spectrum.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/elementary.h"
#include "data/bridge.h"
#include "dcnn/core/random.h"
#include "dcnn/physics/axis_machine.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/noise_floor.h"
#include "diagnosis/periodograms.h"

namespace dcnn {
namespace {

constexpr std::uint64_t kSeed = 1;  // of the noise that is drawn: the same for every case

/// Noise of a logged column: of its samples, and of the samples that it is the difference of.
struct ColumnNoise {
  double white = 0.0, differenced = 0.0;  ///< variances per sample
};

/// Density of the first difference of white noise of variance 1.
double difference_shape(double hz, double dt) {
  return 2.0 - 2.0 * elementary::cos(2.0 * std::numbers::pi * hz * dt);
}

/// Of a column within its segments: of slow motion, whose power is far above the noise's, less
/// leaks through a window's side lobes into the upper band.
Eigen::MatrixXd second_differences(const Bridged& x) {
  Eigen::MatrixXd differences = Eigen::MatrixXd::Zero(x.columns.rows(), 1);
  for (const Segment& s : x.segments) {
    for (Index i = s.begin + 2; i < s.end; ++i) {
      differences(i) = x.columns(i) - 2.0 * x.columns(i - 1) + x.columns(i - 2);
    }
  }
  return differences;
}

/// Of a column, from the upper half of the band, as the smoother has it: of white and differenced
/// white noise in any shares the likeliest (Whittle).
ColumnNoise noise_of(const Case& study, const std::string& name) {
  Case even;  // of which only the clock matters
  Signals signals;
  for (const Log& log : study.logs) {
    if (!log.recording.has(name)) return {};
    Bridged clocked = bridged(log.recording.column(name), log.recording);
    signals.push_back(second_differences(clocked));
    even.logs.emplace_back();
    even.logs.back().motion.dt = study.dt();
    even.logs.back().motion.segments = std::move(clocked.segments);
  }
  const Periodograms p = periodograms(even, signals, 0);
  if (p.power.cols() == 0) return {};
  const Eigen::VectorXd density = density_of(p);
  const double from = std::max(quiet_band(study), 0.25 / study.dt());
  ColumnNoise best;
  double most = -std::numeric_limits<double>::infinity();
  for (const double share : {1.0, 0.9, 0.7, 0.5, 0.3, 0.1, 0.03, 0.01, 0.0}) {
    double level = 0.0, logs = 0.0, bins = 0.0;
    for (Index i = 0; i < p.hz.size(); ++i) {
      if (p.hz(i) < from || p.hz(i) > 0.49 / study.dt()) continue;
      const double once = difference_shape(p.hz(i), study.dt());
      const double shape = (share + (1.0 - share) * once) * once * once;
      level += density(i) / shape, logs += elementary::log(shape), ++bins;
    }
    if (bins == 0.0 || !(level > 0.0)) return {};
    level /= bins;
    const double likelihood = -logs - bins * elementary::log(level);
    if (likelihood > most) {
      most = likelihood;
      best = {share * level, (1.0 - share) * level};
    }
  }
  return best;
}

/// The case with noise of the density of each column's own in the motion that is logged.
Case with_more_noise(const Case& study) {
  Case noisy = study;
  Rng rng(kSeed);
  for (const std::string& name : motion_columns(*study.axis)) {
    const ColumnNoise noise = noise_of(study, name);
    const double white = std::sqrt(noise.white), before = std::sqrt(noise.differenced);
    for (Log& log : noisy.logs) {
      Eigen::VectorXd x = log.recording.column(name);
      double last = rng.normal();
      for (double& value : x) {
        const double next = rng.normal();
        value += white * rng.normal() + before * (next - last);
        last = next;
      }
      log.recording.set(name, x);
    }
  }
  return noisy;
}

/// Mean density of what noise in the motion makes of the prediction, in even steps up to half the
/// rate.
std::vector<double> drawn_density(const Case& study, std::vector<Member> members) {
  std::erase_if(members, [&](const Member& m) { return !brings_position_noise(study, m); });
  Case clean = study, noisy = with_more_noise(study);
  set_axis_motion(clean);
  set_axis_motion(noisy);
  Signals error = predict(noisy, members);
  const Signals exact = predict(clean, members);
  for (std::size_t k = 0; k < error.size(); ++k) error[k] -= exact[k];
  const Periodograms p = periodograms(study, error, 0);  // of its segments, ends cut off or not
  if (p.power.cols() == 0) return {};
  const Eigen::VectorXd density = p.power.rowwise().mean();
  return {density.begin(), density.end()};
}

}  // namespace

std::set<std::string> motion_columns(const AxisPlan& plan) {
  std::set<std::string> names;
  for (std::size_t k = 0; k < plan.system.axes.size(); ++k) {
    if (k != plan.index && plan.system.arm.is_null()) continue;
    const Axis& axis = plan.system.axes[k];
    for (const auto* name : {&axis.position, &axis.velocity, &axis.acceleration}) {
      if (!name->empty()) names.insert(*name);
    }
  }
  return names;
}

bool brings_position_noise(const Case& study, const Member& member) {
  // An encoder at rest has no noise: what friction and cables would make of that which is drawn
  // there says nothing. Inertias make most of it.
  return study.axis && std::string(member.kind->kind) == "parameter";
}

void add_position_noise(const Case& study, const std::vector<Member>& members, const Signals& left,
                        std::vector<Floor>& floors) {
  if (!study.axis) return;
  floors[0].pose_gain.clear();
  std::vector<double> density = drawn_density(study, members);
  const Periodograms p = periodograms(study, left, 0);
  for (std::size_t first = 0; first < density.size();) {
    const std::size_t end = std::min(density.size(), 2 * first + 1);
    double drawn = 0.0, residual = 0.0;
    for (std::size_t k = first; k < end; ++k) {
      drawn += density[k], residual += p.power.row(static_cast<Index>(k)).mean();
    }
    for (std::size_t k = first; k < end && drawn > residual; ++k) density[k] *= residual / drawn;
    first = end;
  }
  if (std::all_of(density.begin(), density.end(), [](double d) { return d == 0.0; })) return;
  floors[0].pose_gain = std::move(density);
  floors[0].static_part = 1.0;
}

double unseen_motion(const Case& study, const std::vector<Member>& members, double hz) {
  if (!study.axis) return 0.0;
  constexpr double kNoFilter = 1e6;  // Hz
  Case open = study;
  open.derivative = {.kind = DerivativeSpec::Kind::kSpectral, .cutoff_hz = kNoFilter};
  Floor floor{.dt = study.dt()};
  floor.pose_gain = drawn_density(open, members);
  floor.static_part = 1.0;
  return floor.pose_density(hz);
}

}  // namespace dcnn
