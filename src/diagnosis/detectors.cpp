// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/detectors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "diagnosis/candidates.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/spectral_lines.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr Index kFewestClipped = 20;
constexpr double kNearLimit = 0.25;  // s, in which noise is clipped and the mean is not the force
constexpr double kFast = 1.25;       // of the motion's band: half the rate of the block means

}  // namespace

std::vector<Clipping> clipping(const Case& study) {
  std::vector<Clipping> list;
  for (Index j = 0; j < study.channel_count(); ++j) {
    if (study.channels[static_cast<std::size_t>(j)] > 2) continue;  // the law limits forces
    double high = -1e300, low = 1e300;
    for (const Log& log : study.logs) {
      high = std::max(high, log.measured.col(j).maxCoeff());
      low = std::min(low, log.measured.col(j).minCoeff());
    }
    Clipping clip{j, std::max(std::abs(high), std::abs(low)), {}};
    if (clip.limit == 0.0) continue;  // a channel without a signal
    // Held at a limit means in a row, and longer than anywhere else: on a lattice as coarse as the
    // noise every value repeats.
    Index longest = 0, elsewhere = 0, total = 0;
    for (std::size_t k = 0; k < study.logs.size(); ++k) {
      const Eigen::VectorXd x = study.logs[k].measured.col(j);
      Index run = 0, equal = 1;
      for (Index i = 0; i < x.size(); ++i) {
        const bool held = std::abs(std::abs(x(i)) - clip.limit) <= 1e-9 * clip.limit;
        run = held ? run + 1 : 0;
        longest = std::max(longest, run);
        equal = i > 0 && x(i) == x(i - 1) ? equal + 1 : 1;
        if (!held) elsewhere = std::max(elsewhere, equal);
        if (!held) continue;
        ++total;
        const double t = study.logs[k].motion.t(i);
        if (clip.spans.empty() || clip.spans.back().log != k || t > clip.spans.back().end) {
          clip.spans.push_back({k, t - kNearLimit, t + kNearLimit});
        }
        clip.spans.back().end = t + kNearLimit;
      }
    }
    if (total >= kFewestClipped && longest >= std::max<Index>(5, 2 * elsewhere + 1))
      list.push_back(clip);
  }
  return list;
}

std::optional<Member> find_fast_hum(const Case& study, const Signals& left,
                                    const std::vector<Floor>& floors) {
  const double top = 0.49 / study.dt();
  const double from = kFast * study.motion_hz;
  if (top < from || study.lowpass_hz > 0.0) return std::nullopt;
  const auto lines = common_lines(study, left, floors, from, top, 1);
  if (lines.empty() || !lines.front().stands_out()) return std::nullopt;

  const Index channels = study.channel_count();
  Eigen::MatrixXd sine(1, channels), cosine(1, channels);
  // The share of the channels' chi-squares that is independent: noise in common counts once.
  const auto terms = static_cast<double>(left.size()) * static_cast<double>(channels);
  const double independent = std::min(1.0, lines.front().terms / terms);
  // Near the smoother's edge the noise of the pose may be far above the floor.
  const double loudness = std::max(1.0, lines.front().beside);
  double samples = 0.0;
  for (const auto& r : left) samples += static_cast<double>(r.rows());
  // Gain in chi-square of the line at hz, with its amplitudes.
  const auto gain_at = [&](double hz) {
    sine.setZero();
    cosine.setZero();
    for (std::size_t k = 0; k < left.size(); ++k) {
      const Eigen::ArrayXd angle = 2.0 * std::numbers::pi * hz * study.logs[k].motion.t.array();
      sine += elementary::sin(angle).matrix().transpose() * left[k];
      cosine += elementary::cos(angle).matrix().transpose() * left[k];
    }
    sine *= 2.0 / samples;
    cosine *= 2.0 / samples;
    double gain = 0.0;
    for (Index j = 0; j < channels; ++j) {
      const double density = floors[static_cast<std::size_t>(j)].density(hz);
      gain += 0.5 * samples * (sine(0, j) * sine(0, j) + cosine(0, j) * cosine(0, j)) / density;
    }
    return independent * gain / loudness;
  };
  const double longest = longest_seconds(study);
  // Recordings one after the other have side lobes, the nearer the further they are apart.
  const double span = study.logs.back().motion.t.tail(1)(0) - study.logs.front().motion.t(0);
  const double width = 2.0 / longest, step = std::max(0.25 / std::max(span, longest), width / 200);
  double best_hz = lines.front().hz, most = gain_at(best_hz);
  for (double f = best_hz - 0.5 * width, end = best_hz + 0.5 * width; f < end; f += step) {
    if (const double gain = gain_at(f); gain > most) most = gain, best_hz = f;
  }
  const Eigen::VectorXd hz =
      simplex_search([&](const Eigen::VectorXd& f) { return -gain_at(f(0)); },
                     Eigen::VectorXd::Constant(1, best_hz), Eigen::VectorXd::Constant(1, step), 40);
  const double gain = gain_at(hz(0));
  const EffectKind& kind = *find_effect("hum");
  Member member = make_member(study, kind, kind.fits[0], "", hz);
  if (gain < prior::kLeastLine + 4.0 * member.parameters()) return std::nullopt;
  const Index half = member.amplitudes.size() / 2;
  member.amplitudes.setZero();
  member.fixed_deviation.setZero(member.amplitudes.size() + 1);
  for (Index j = 0; j < channels; ++j) {
    const int c = study.channels[static_cast<std::size_t>(j)];
    member.amplitudes(c) = sine(0, j);
    member.amplitudes(half + c) = cosine(0, j);
    const double density = floors[static_cast<std::size_t>(j)].density(hz(0));
    member.fixed_deviation(c) = member.fixed_deviation(half + c) =
        std::sqrt(2.0 * density * loudness / samples);
  }
  // Rife and Boorstyn 1974: of the frequency, from the gain as signal-to-noise ratio.
  member.fixed_deviation(member.amplitudes.size()) =
      std::sqrt(3.0 / std::max(gain, 1.0)) / (std::numbers::pi * longest);
  member.fixed = true;
  return member;
}

bool is_heard_hum(const Member& member) {
  return member.fixed && member.own_shapes() > 0 &&
         member.shape(0).peak == ShapeParameter::Peak::kLine;
}

}  // namespace dcnn
