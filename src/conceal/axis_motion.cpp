// SPDX-License-Identifier: Apache-2.0
// Motions of an axis as machines make them, twice differentiable.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conceal/axis_world.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
constexpr double kRound = 2.0 * std::numbers::pi;

/// Sum of 4 to 7 sines, amplitudes falling as 1/f above the axis' frequency; closed forms of all.
void move_in_tones(const AxisBody& body, AxisPath& path, Rng& rng) {
  const int tones = 4 + static_cast<int>(rng.below(4));
  for (int k = 0; k < tones; ++k) {
    const double hz = body.hz * logarithmic(rng, 0.2, 2.0), w = kRound * hz;
    const double size = body.reach * std::sqrt(1.0 / tones) * std::min(1.0, body.hz / hz);
    const double phase = rng.uniform(0.0, kRound);
    for (Index i = 0; i < path.q.size(); ++i) {
      const double angle = w * path.step * static_cast<double>(i) + phase;
      const double s = elementary::sin(angle), c = elementary::cos(angle);
      path.q(i) += size * s, path.v(i) += size * w * c, path.a(i) -= size * w * w * s;
    }
  }
}

/// Mean over `width` samples about each; the ends repeat.
VectorXd box(const VectorXd& x, Index width) {
  VectorXd y(x.size());
  const Index half = width / 2, n = x.size();
  for (Index i = 0; i < n; ++i) {  // sums of equal values stay exact: rests are rests
    if (i == 0 || x(std::min(n - 1, i + half)) != x(std::max<Index>(0, i - half - 1))) {
      if (i == 0) {
        y(0) = 0.0;
        for (Index k = -half; k <= half; ++k) y(0) += x(std::clamp<Index>(k, 0, n - 1));
      } else {
        y(i) = y(i - 1) + x(std::min(n - 1, i + half)) - x(std::max<Index>(0, i - half - 1));
      }
    } else {
      y(i) = y(i - 1);
    }
  }
  return y / static_cast<double>(2 * half + 1);
}

/// q and a of the velocity that is there: trapezoidal rule, central differences.
void complete(AxisPath& path) {
  const Index n = path.v.size();
  for (Index i = 1; i < n; ++i)
    path.q(i) = path.q(i - 1) + 0.5 * path.step * (path.v(i - 1) + path.v(i));
  for (Index i = 1; i + 1 < n; ++i) path.a(i) = (path.v(i + 1) - path.v(i - 1)) / (2.0 * path.step);
}

/// A commanded speed that jumps, passed through ramps of `ramp` seconds with rounded corners.
void follow_speed(const VectorXd& commanded, double ramp, AxisPath& path) {
  const auto width = std::max<Index>(3, static_cast<Index>(ramp / path.step));
  path.v = box(box(commanded, width), std::max<Index>(3, width / 3));
  const double still = 1e-9 * path.v.cwiseAbs().maxCoeff();
  path.v = path.v.unaryExpr([=](double v) { return std::abs(v) < still ? 0.0 : v; });
  complete(path);
}

/// Moves at a constant speed to drawn places within the reach, then rests.
void move_in_trapezoids(const AxisBody& body, double resting, AxisPath& path, Rng& rng) {
  const double ramp = rng.uniform(0.05, 0.2) / body.hz;
  VectorXd v = VectorXd::Zero(path.q.size());
  double at = 0.0;
  for (Index i = 0; i < v.size();) {
    const double to = body.reach * rng.uniform(-1.0, 1.0), speed = body.speed();
    const double seconds =
        std::max(2.0 * ramp, std::abs(to - at) / (speed * rng.uniform(0.3, 1.0)));
    const auto moving = static_cast<Index>(seconds / path.step);
    for (Index k = 0; k < moving && i < v.size(); ++k, ++i) v(i) = (to - at) / seconds;
    const double rest = seconds * resting / (1.0 - resting) * rng.uniform(0.5, 1.5);
    i += static_cast<Index>((rest + (resting > 0.0 ? 1.5 * ramp : 0.0)) / path.step);
    at = to;
  }
  follow_speed(v, ramp, path);
}

void move_in_triangles(const AxisBody& body, AxisPath& path, Rng& rng) {
  const double period = rng.uniform(0.7, 1.5) / body.hz, ramp = rng.uniform(0.02, 0.06) * period;
  const double phase = rng.uniform();
  VectorXd v(path.q.size());
  for (Index i = 0; i < v.size(); ++i) {
    const double turns = path.step * static_cast<double>(i) / period + phase;
    v(i) = (turns - std::floor(turns) < 0.5 ? 4.0 : -4.0) * body.reach / period;
  }
  follow_speed(v, ramp, path);
}

/// Speeds of one direction held for a while, a stop or a short way back between some of them; over
/// the recording the axis passes its range at most.
void move_one_way(const AxisBody& body, double resting, AxisPath& path, Rng& rng) {
  const double sign = rng.uniform() < 0.5 ? -1.0 : 1.0, ramp = rng.uniform(0.05, 0.2) / body.hz;
  VectorXd v = VectorXd::Zero(path.q.size());
  const double seconds = path.step * static_cast<double>(v.size());
  const double most = std::min(body.speed(), 4.0 * body.reach / seconds);
  for (Index i = 0; i < v.size();) {
    const double speed = sign * most * logarithmic(rng, 0.1, 1.0);
    const bool back = rng.uniform() < 0.15;
    const auto held =
        static_cast<Index>((back ? 0.3 : rng.uniform(0.5, 2.0)) / body.hz / path.step);
    for (Index k = 0; k < held && i < v.size(); ++k, ++i) v(i) = back ? -0.5 * speed : speed;
    if (rng.uniform() < resting) i += held / 2;
  }
  follow_speed(v, ramp, path);
}

/// Sweep from a tenth of the axis' frequency to twice it; the amplitude falls as 1/√f.
void sweep(const AxisBody& body, AxisPath& path, Rng& rng) {
  const double low = 0.1 * body.hz, growth = 20.0;  // f = low growth^(t/T), phase is its integral
  const double seconds = path.step * static_cast<double>(path.q.size()),
               log = elementary::log(growth);
  const double phase = rng.uniform(0.0, kRound);
  VectorXd q(path.q.size());
  for (Index i = 0; i < q.size(); ++i) {
    const double rise = elementary::pow(growth, path.step * static_cast<double>(i) / seconds);
    q(i) = body.reach / std::sqrt(rise) *
           elementary::sin(kRound * low * seconds / log * (rise - 1.0) + phase);
  }
  for (Index i = 1; i + 1 < q.size(); ++i) path.v(i) = (q(i + 1) - q(i - 1)) / (2.0 * path.step);
  path.v(0) = path.v(1), path.v(q.size() - 1) = path.v(q.size() - 2);
  complete(path);
  path.q.array() += q(0);
}

/// White noise through five equal first-order lags: its acceleration is continuous.
void move_in_noise(const AxisBody& body, AxisPath& path, Rng& rng) {
  const double keep = elementary::exp(-kRound * body.hz * path.step);
  const auto run_in = static_cast<Index>(3.0 / (body.hz * path.step));
  double lag[5] = {};
  VectorXd v(path.q.size());
  for (Index i = -run_in; i < v.size(); ++i) {
    double x = rng.normal();
    for (double& y : lag) x = y = keep * y + (1.0 - keep) * x;
    if (i >= 0) v(i) = x;
  }
  v.array() -= v.mean();
  path.v = v;
  complete(path);
  path.q.array() -= path.q.mean();
  const double scale = body.reach / std::max(1e-300, path.q.cwiseAbs().maxCoeff());
  path.q *= scale, path.v *= scale, path.a *= scale;
}

/// Reaches of least jerk (Flash and Hogan 1985) between drawn places, with pauses.
void reach(const AxisBody& body, double resting, AxisPath& path, Rng& rng) {
  double at = 0.0;
  for (Index i = 0; i < path.q.size();) {
    const double to = body.reach * rng.uniform(-1.0, 1.0),
                 seconds = rng.uniform(0.3, 1.0) / body.hz;
    const double pause = seconds * resting / (1.0 - resting) * rng.uniform(0.2, 1.8), way = to - at;
    for (double t = 0.0; t < seconds + pause && i < path.q.size(); t += path.step, ++i) {
      const double u = std::min(1.0, t / seconds);
      path.q(i) = at + way * u * u * u * (10.0 + u * (6.0 * u - 15.0));
      path.v(i) = way * 30.0 * u * u * (1.0 - u) * (1.0 - u) / seconds;
      path.a(i) = way * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (seconds * seconds);
    }
    at = to;
  }
}

}  // namespace

double AxisBody::speed() const { return kRound * hz * reach; }

Eigen::VectorXd AxisPath::logged(const VectorXd& signal) const {
  VectorXd out(rows);
  for (Index i = 0; i < rows; ++i) out(i) = signal(before + i * per_row);
  return out;
}

const std::vector<std::string>& axis_motions() {
  static const std::vector<std::string> all{"tones", "trapezoids", "triangles", "chirp",
                                            "noise", "one_way",    "reaches"};
  return all;
}

void make_axis_motion(const std::string& kind, const AxisBody& body, double resting, Index samples,
                      AxisPath& path, Rng& rng) {
  path.q = path.v = path.a = VectorXd::Zero(samples);
  if (kind == "tones")
    move_in_tones(body, path, rng);
  else if (kind == "trapezoids")
    move_in_trapezoids(body, resting, path, rng);
  else if (kind == "triangles")
    move_in_triangles(body, path, rng);
  else if (kind == "chirp")
    sweep(body, path, rng);
  else if (kind == "noise")
    move_in_noise(body, path, rng);
  else if (kind == "one_way")
    move_one_way(body, resting, path, rng);
  else
    reach(body, resting, path, rng);
  if (kind == "triangles") path.q.array() -= 0.5 * (path.q.maxCoeff() + path.q.minCoeff());
  path.q.array() += body.centre;
}

}  // namespace dcnn::conceal
