// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/trajectory.h"

#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "physics/vectors.h"

namespace dcnn {
namespace {

const Eigen::VectorXd kNowhere = Eigen::VectorXd::Zero(3);

/// A sum of sines, amplitude·sin(omega t + phase).
struct Tone {
  double amplitude, omega, phase;
};
using Tones = std::vector<Tone>;

/// How the tones of one coordinate are drawn.
using Draw = Tones (*)(int tones, double low_hz, double high_hz, Rng& rng);

/// Log-spaced over the band, each up to 0.15 of a spacing higher than a regular grid. With one grid
/// for all six coordinates every feature would be a mix of the same twelve sines and cosines, and
/// no identifier could tell from one recording which feature makes the force.
Tones equal_tones(int tones, double low_hz, double high_hz, Rng& rng) {
  constexpr double kShift = 0.15;
  Tones list;
  for (int k = 0; k < tones; ++k) {
    const double place = (k + kShift * rng.uniform()) / (tones - 1 + kShift);
    const double hz = low_hz * elementary::pow(high_hz / low_hz, place);
    list.push_back(
        {1.0 / tones, 2.0 * std::numbers::pi * hz, rng.uniform(0.0, 2.0 * std::numbers::pi)});
  }
  return list;
}

Tones band_tones(int tones, double low_hz, double high_hz, Rng& rng) {
  Tones list;
  for (int k = 0; k < tones; ++k) {
    const double hz = low_hz * elementary::pow(high_hz / low_hz, (k + rng.uniform()) / tones);
    const double amplitude = elementary::pow(hz, -0.9) * rng.uniform(0.6, 1.4);
    list.push_back(
        {amplitude, 2.0 * std::numbers::pi * hz, rng.uniform(0.0, 2.0 * std::numbers::pi)});
  }
  return list;
}

/// Value, first and second derivative of a coordinate, (T,3).
Eigen::MatrixXd sample(const Tones& tones, const Eigen::VectorXd& t) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(t.size(), 3);
  for (const Tone& tone : tones) {
    const Eigen::ArrayXd angle = tone.omega * t.array() + tone.phase;
    const Eigen::ArrayXd sine = tone.amplitude * elementary::sin(angle);
    out.col(0).array() += sine;
    out.col(1).array() += tone.amplitude * tone.omega * elementary::cos(angle);
    out.col(2).array() -= tone.omega * tone.omega * sine;
  }
  return out;
}

/// Three coordinates of `size` about `centre`; `to_peak` scales the sampled peak to the size.
struct Group {
  Eigen::VectorXd size, centre;
  bool to_peak;
};

Group read_group(Options& options, const std::string& size_key, const std::string& centre_key,
                 bool to_peak) {
  Group group{read_list(options, size_key, kNowhere), read_list(options, centre_key, kNowhere),
              to_peak};
  if ((group.size.array() < 0.0).any()) options.reject(size_key, "must not be negative");
  return group;
}

Trajectory sum_of_sines(Options& options, const Sampling& sampling, Rng& rng, Draw draw,
                        bool to_peak) {
  const int tones = options.get("tones", 6);
  if (tones < 1 || tones > 1000) options.reject("tones", "must be between 1 and 1000, not ", tones);
  const Eigen::VectorXd hz = read_list(options, "hz", Eigen::Vector2d(0.03, 1.0));
  if (!(hz(0) > 0.0 && hz(1) >= hz(0) && hz(1) * sampling.dt < 0.5)) {
    options.reject("hz", "must be [low, high] with 0 < low <= high < half the sample rate");
  }
  const Group groups[] = {read_group(options, "position_m", "position_center_m", to_peak),
                          read_group(options, "angle_rad", "angle_center_rad", to_peak)};
  Trajectory out;
  out.dt = sampling.dt;
  out.t = sampling.t0 + Eigen::ArrayXd::LinSpaced(sampling.samples, 0.0,
                                                  static_cast<double>(sampling.samples - 1)) *
                            sampling.dt;
  Eigen::MatrixXd* const blocks[][3] = {{&out.position, &out.velocity, &out.acceleration},
                                        {&out.euler, &out.euler_rate, &out.euler_acceleration}};
  for (std::size_t g = 0; g < 2; ++g) {
    for (auto* block : blocks[g]) block->resize(sampling.samples, 3);
    for (Index i = 0; i < 3; ++i) {
      Eigen::MatrixXd values = sample(draw(tones, hz(0), hz(1), rng), out.t);
      const double peak = groups[g].to_peak ? values.col(0).cwiseAbs().maxCoeff() : 1.0;
      values *= groups[g].size(i) / peak;
      values.col(0).array() += groups[g].centre(i);
      for (Index d = 0; d < 3; ++d) blocks[g][d]->col(i) = values.col(d);
    }
  }
  return out;
}

Trajectory multisine(Options& options, const Sampling& sampling, Rng& rng) {
  return sum_of_sines(options, sampling, rng, equal_tones, false);
}

Trajectory band_multisine(Options& options, const Sampling& sampling, Rng& rng) {
  return sum_of_sines(options, sampling, rng, band_tones, true);
}

Trajectory poses_at_rest(Options& options, const Sampling& sampling, Rng& rng) {
  const Group angles = read_group(options, "angle_rad", "angle_center_rad", false);
  Trajectory out;
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(sampling.samples, 3);
  out.t = zero.col(0);
  out.position = out.velocity = out.acceleration = out.euler_rate = out.euler_acceleration = zero;
  out.euler.resize(sampling.samples, 3);
  for (Index k = 0; k < sampling.samples; ++k) {
    for (Index i = 0; i < 3; ++i) {
      out.euler(k, i) = angles.centre(i) + angles.size(i) * rng.uniform(-1.0, 1.0);
    }
  }
  return out;
}

struct Kind {
  const char* name;
  Trajectory (*make)(Options&, const Sampling&, Rng&);
};
constexpr Kind kKinds[] = {
    {"multisine", multisine}, {"band_multisine", band_multisine}, {"static", poses_at_rest}};

}  // namespace

std::vector<std::string> trajectory_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.push_back(kind.name);
  return names;
}

Trajectory make_trajectory(Options options, const Sampling& sampling, Rng& rng) {
  const std::string word = options.choice("kind", "multisine", trajectory_kinds());
  for (const Kind& kind : kKinds) {
    if (word != kind.name) continue;
    Trajectory trajectory = kind.make(options, sampling, rng);
    options.finish();
    return trajectory;
  }
  options.reject("kind", "is unknown");
}

}  // namespace dcnn
