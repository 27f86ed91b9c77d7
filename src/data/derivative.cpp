// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/derivative.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/elementary.h"
#include "data/bridge.h"
#include "data/limits.h"
#include "data/spectral.h"
#include "data/spline.h"

namespace dcnn {
namespace {

using Kind = DerivativeSpec::Kind;
using Input = Eigen::Ref<const Eigen::VectorXd>;
using Output = Eigen::Ref<Eigen::VectorXd>;

const std::vector<std::string> kKinds = {"sg", "sg_causal", "central", "spline",
                                         "spectral"};  // in enum order

/// Weights of the first and the second derivative, per second and per second squared.
struct Weights {
  Weights(int window, int order, double at, double dt)
      : first(savitzky_golay_weights(window, order, 1, at) / dt),
        second(savitzky_golay_weights(window, order, 2, at) / (dt * dt)) {}
  Eigen::VectorXd first, second;
};

constexpr Index kTile = 8, kPiece = 1024 * kTile;

/// first[i] = sum_k w.first[k]·x[i + k], the same for second. Eight results at a time stay in
/// registers.
void slide_block(const Weights& w, const double* x, Index count, double* first, double* second) {
  using Tile = Eigen::Array<double, kTile, 1>;
  Index i = 0;
  for (; i + kTile <= count; i += kTile) {
    Tile one = Tile::Zero(), two = Tile::Zero();
    for (Index k = 0; k < w.first.size(); ++k) {
      const Eigen::Map<const Tile> part(x + i + k);
      one += w.first[k] * part;
      two += w.second[k] * part;
    }
    Eigen::Map<Tile>(first + i) = one;
    Eigen::Map<Tile>(second + i) = two;
  }
  for (; i < count; ++i) {
    const Eigen::Map<const Eigen::VectorXd> part(x + i, w.first.size());
    first[i] = w.first.dot(part);
    second[i] = w.second.dot(part);
  }
}

void slide(const Weights& w, const double* x, Index count, double* first, double* second) {
  for_each_piece((count + kPiece - 1) / kPiece, [&](Index k) {
    const Index i = k * kPiece;
    slide_block(w, x + i, std::min(kPiece, count - i), first + i, second + i);
  });
}

/// Centred fits; at the ends the outermost fit evaluated off-centre.
void centred(const Input& x, int window, int order, double dt, Output first, Output second) {
  const Index half = window / 2, n = x.size();
  slide(Weights(window, order, static_cast<double>(half), dt), x.data(), n - window + 1,
        first.data() + half, second.data() + half);
  for (Index k = 0; k < half; ++k) {
    const Weights head(window, order, static_cast<double>(k), dt);
    const Weights tail(window, order, static_cast<double>(window - 1 - k), dt);
    first[k] = head.first.dot(x.head(window));
    second[k] = head.second.dot(x.head(window));
    first[n - 1 - k] = tail.first.dot(x.tail(window));
    second[n - 1 - k] = tail.second.dot(x.tail(window));
  }
}

/// Fits to the last samples, evaluated at the newest; before the first sample it is repeated.
void causal(const Input& x, int window, int order, double dt, Output first, Output second) {
  Eigen::VectorXd padded(x.size() + window - 1);
  padded << Eigen::VectorXd::Constant(window - 1, x[0]), x;
  slide(Weights(window, order, window - 1.0, dt), padded.data(), x.size(), first.data(),
        second.data());
}

/// MATLAB's gradient: central differences, one-sided at the ends.
void gradient(const Input& x, double dt, Output out) {
  const Index n = x.size();
  out[0] = (x[1] - x[0]) / dt;
  out[n - 1] = (x[n - 1] - x[n - 2]) / dt;
  for (Index i = 1; i + 1 < n; ++i) out[i] = (x[i + 1] - x[i - 1]) / (2.0 * dt);
}

void by_spline(const Input& t, const Input& x, Output first, Output second) {
  const Spline spline(t, x);
  second = spline.curvature();
  for (Index i = 0; i < x.size(); ++i) first[i] = spline.slope(i);
}

/// Whether motion beyond the cut-off has passed.
bool by_spectrum(const LowPass& filter, double dt, Output x, Output first, Output second) {
  const Smoothed smoothed = smooth(x, dt, filter);
  first = smoothed.first;
  second = smoothed.second;
  x = smoothed.value;
  return smoothed.is_fast;
}

void check_lengths(const Recording& recording, const DerivativeSpec& spec) {
  require(recording.dt > 0.0, Exit::kData, recording.name,
          ": has no column 't', so no derivatives; log the time or use features of the pose alone");
  require(spec.window(recording.dt) <= kLongestWindow, Exit::kData, recording.name,
          ": derivative.window_s of ", spec.window_s, " s is more than ", kLongestWindow,
          " samples of ", recording.dt, " s; shorten it");
  const int least = spec.fewest_rows(recording.dt);
  for (const Segment& segment : recording.segments) {
    require(segment.size() >= least, Exit::kData, recording.name, ": samples ", segment.begin + 1,
            " to ", segment.end, " between two gaps are fewer than the ", least,
            " that derivatives need; cut them out or shorten derivative.window_s");
  }
}

}  // namespace

int DerivativeSpec::window(double dt) const {
  assert(dt > 0.0);
  constexpr double kMost = 1e8;
  const int wanted = 2 * static_cast<int>(std::min(std::round(window_s / (2.0 * dt)), kMost)) + 1;
  const int least = order + 4 + (order % 2 == 0 ? 1 : 0);
  return std::max(wanted, least);
}

int DerivativeSpec::fewest_rows(double dt) const {
  if (kind == Kind::kCentral) return 2;
  if (kind == Kind::kSpline || kind == Kind::kSpectral) return 3;
  return kind == Kind::kSavitzkyGolay ? window(dt) : 1;
}

DerivativeSpec parse_derivative(Options options) {
  DerivativeSpec spec;
  const std::string kind = options.choice("kind", "sg", kKinds);
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    if (kKinds[k] == kind) spec.kind = static_cast<Kind>(k);
  }
  spec.window_s = options.number("window_s", spec.window_s, 0.0, 100.0);
  spec.cutoff_hz = options.number("cutoff_hz", spec.cutoff_hz, 1e-3, 1e6);
  spec.subtraction = options.number("subtraction", spec.subtraction, 0.0, 100.0);
  if (options.raw("most_noise").is_array()) {
    spec.most_noise = options.get<std::vector<double>>("most_noise");
    for (const double most : spec.most_noise) {
      if (!(most >= 0.0)) options.reject("most_noise", "must hold no negative number");
    }
  } else if (const double most = options.number("most_noise", 0.0, 0.0, 1e300); most > 0.0) {
    spec.most_noise = {most};
  }
  spec.fastest_hz = options.number("fastest_hz", spec.fastest_hz, 0.0, 1e6);
  spec.order = options.get("order", spec.kind == Kind::kCausalSavitzkyGolay ? 2 : 3);
  if (spec.order < 2 || spec.order > 7) options.reject("order", "must be between 2 and 7");
  options.finish();
  return spec;
}

Json to_json(const DerivativeSpec& spec) {
  if (spec.kind == Kind::kSpectral) {
    Json json{{"kind", "spectral"}, {"cutoff_hz", spec.cutoff_hz}};
    if (spec.subtraction > 0.0) json["subtraction"] = spec.subtraction;
    if (!spec.most_noise.empty()) json["most_noise"] = spec.most_noise;
    if (spec.fastest_hz != DerivativeSpec().fastest_hz) json["fastest_hz"] = spec.fastest_hz;
    return json;
  }
  return {{"kind", kKinds[static_cast<std::size_t>(spec.kind)]},
          {"window_s", spec.window_s},
          {"order", spec.order}};
}

// Least squares in polynomials p_j orthogonal on the samples z in [-1, 1] (Gram), by the recursion
// p_{j+1} = z·p_j - b_j·p_{j-1}: the weight of sample k is sum_j p_j(z_k)·p_j^(d)(at)/<p_j, p_j>.
Eigen::VectorXd savitzky_golay_weights(int window, int order, int derivative, double at) {
  assert(window > order && derivative >= 0 && derivative <= 2);
  const double half = 0.5 * (window - 1), z_at = (at - half) / half;
  const Eigen::ArrayXd z = Eigen::ArrayXd::LinSpaced(window, -1.0, 1.0);
  Eigen::ArrayXd p = Eigen::ArrayXd::Ones(window), p_before = Eigen::ArrayXd::Zero(window);
  Eigen::Array3d q(1.0, 0.0, 0.0),
      q_before = Eigen::Array3d::Zero();  // p_j(at) and its derivatives
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(window);
  double norm = window, norm_before = 1.0;
  for (int j = 0; j <= order; ++j) {
    weights += (p * (q[derivative] / norm)).matrix();
    const double b = j == 0 ? 0.0 : norm / norm_before;
    const Eigen::ArrayXd p_next = z * p - b * p_before;
    const Eigen::Array3d q_next = z_at * q + Eigen::Array3d(0.0, q[0], 2.0 * q[1]) - b * q_before;
    p_before = p, p = p_next;
    q_before = q, q = q_next;
    norm_before = norm, norm = p.square().sum();
  }
  return weights / elementary::pow(half, derivative);
}

Derivatives differentiate(Eigen::MatrixXd signals, const Recording& recording,
                          const DerivativeSpec& spec) {
  check_lengths(recording, spec);
  const double dt = recording.dt;
  const int window = spec.window(dt);
  const Eigen::VectorXd t = times_of(recording, signals.rows());
  std::vector<std::vector<Index>> places;
  for (const Segment& s : recording.segments) places.push_back(clock_places(t, s, dt));
  Derivatives out{Eigen::MatrixXd(signals.rows(), signals.cols()),
                  Eigen::MatrixXd(signals.rows(), signals.cols()), std::move(signals)};
  std::vector<char> is_fast(static_cast<std::size_t>(out.value.cols()));
  const auto estimate = [&](Index column, Input t_here, Output x, Output first, Output second) {
    switch (spec.kind) {
      case Kind::kSavitzkyGolay:
        return centred(x, window, spec.order, dt, first, second);
      case Kind::kCausalSavitzkyGolay:
        return causal(x, window, spec.order, dt, first, second);
      case Kind::kSpline:
        return by_spline(t_here, x, first, second);
      case Kind::kSpectral:
        if (by_spectrum({spec.cutoff_hz, spec.subtraction, spec.most_noise, spec.fastest_hz}, dt, x,
                        first, second))
          is_fast[static_cast<std::size_t>(column)] = 1;
        return;
      case Kind::kCentral:
        gradient(x, dt, first);
        return gradient(first, dt, second);
    }
  };
  const auto one_column = [&](Index column) {
    for (std::size_t k = 0; k < recording.segments.size(); ++k) {
      const Segment& s = recording.segments[k];
      const auto t_here = t.segment(s.begin, s.size());
      auto x = out.value.col(column).segment(s.begin, s.size());
      auto first = out.first.col(column).segment(s.begin, s.size());
      auto second = out.second.col(column).segment(s.begin, s.size());
      const std::vector<Index>& at = places[k];
      if (spec.kind == Kind::kSpline || at.back() + 1 == s.size()) {
        estimate(column, t_here, x, first, second);
        continue;
      }
      Eigen::VectorXd all = bridged(x, at), all_first(all.size()), all_second(all.size());
      estimate(column, t_here, all, all_first, all_second);
      x = all(at);
      first = all_first(at);
      second = all_second(at);
    }
  };
  const bool slides = spec.kind == Kind::kSavitzkyGolay || spec.kind == Kind::kCausalSavitzkyGolay;
  if (slides) {  // whose blocks are shared among the threads: columns are few
    for (Index column = 0; column < out.value.cols(); ++column) one_column(column);
  } else {
    for_each_piece(out.value.cols(), one_column);
  }
  out.is_fast = std::any_of(is_fast.begin(), is_fast.end(), [](char fast) { return fast != 0; });
  return out;
}

}  // namespace dcnn
