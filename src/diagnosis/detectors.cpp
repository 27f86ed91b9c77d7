#include "diagnosis/detectors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/candidates.h"
#include "diagnosis/median.h"
#include "diagnosis/spectral_lines.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr double kKnock = 5.5;  // deviations
constexpr double kLoud = 10.0;  // deviations
constexpr double kMany = 9.0;
constexpr double kAlike = 0.2;        // of the highest
constexpr double kMostWrong = 0.15;   // of the strength of all, against the field
constexpr double kSignificant = 5.0;  // deviations of a fair coin, where more are wrong
constexpr Index kFewestClipped = 20;
constexpr double kNearLimit = 0.25;  // s, in which noise is clipped and the mean is not the force
constexpr double kFast = 1.25;       // of the motion's band: half the rate of the block means

double median_size(const Eigen::VectorXd& x) {
  const Eigen::VectorXd size = x.cwiseAbs();
  return median({size.begin(), size.end()});
}

/// Means over `wide` samples to either side of each.
Eigen::VectorXd running_mean(const Eigen::VectorXd& x, Index wide) {
  Eigen::VectorXd sums(x.size() + 1);
  sums(0) = 0.0;
  for (Index i = 0; i < x.size(); ++i) sums(i + 1) = sums(i) + x(i);
  Eigen::VectorXd mean(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const Index from = std::max<Index>(0, i - wide), to = std::min(x.size(), i + wide + 1);
    mean(i) = (sums(to) - sums(from)) / static_cast<double>(to - from);
  }
  return mean;
}

struct Spike {
  Index at;
  double base;    ///< median of what is around it
  double height;  ///< above that, in deviations of such heights
};

/// Where a channel knocks, strongest of each 60 ms: means over the some 6 ms of a knock, so that
/// wild samples do not count, above what is around them, so that other forces do not.
std::vector<Spike> spikes(const Eigen::VectorXd& r, const Eigen::VectorXd& level, double dt) {
  const Index half = std::max<Index>(2, std::llround(0.025 / dt));
  const Index apart = std::max<Index>(1, std::llround(0.06 / dt));
  if (r.size() < 4 * half) return {};
  const Eigen::VectorXd even = r.cwiseQuotient(level);
  const Eigen::VectorXd x = running_mean(even, static_cast<Index>(0.003 / dt));
  const Eigen::VectorXd away = x - running_mean(even, half);
  const double sigma = 1.4826 * median_size(away);
  std::vector<Spike> found;
  for (Index i = half; i + half < r.size(); ++i) {
    if (std::abs(away(i)) < 0.8 * kKnock * sigma) continue;
    const double base = median({x.data() + i - half, x.data() + i + half + 1});
    const Spike spike{i, base * level(i), (x(i) - base) / sigma};
    if (std::abs(spike.height) < kKnock) continue;
    if (found.empty() || i - found.back().at >= apart) {
      found.push_back(spike);
    } else if (std::abs(spike.height) > std::abs(found.back().height)) {
      found.back() = spike;
    }
  }
  return found;
}

/// Of each recording; knocks differ by how fast the field turns, and wild samples are far below.
std::vector<std::vector<Spike>> alike_spikes(const Signals& left,
                                             const std::vector<Eigen::VectorXd>& levels,
                                             Index channel, double dt) {
  std::vector<std::vector<Spike>> all;
  double highest = 0.0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    all.push_back(spikes(left[k].col(channel), levels[k], dt));
    for (const Spike& s : all.back()) highest = std::max(highest, std::abs(s.height));
  }
  for (auto& log : all) {
    std::erase_if(log, [&](const Spike& s) { return std::abs(s.height) < kAlike * highest; });
  }
  return all;
}

/// When the field last changed its sign before sample i, at most 2 s earlier; -1 if it did not.
Index turned_before(const Eigen::VectorXd& field, Index i, double dt) {
  const Index least = std::max<Index>(1, i - std::llround(2.0 / dt));
  for (Index k = i; k >= least; --k) {
    if (field(k) * field(k - 1) <= 0.0) return k;
  }
  return -1;
}

}  // namespace

std::vector<Clipping> clipping(const Case& study) {
  std::vector<Clipping> list;
  for (Index j = 0; j < study.channel_count(); ++j) {
    double high = -1e300, low = 1e300;
    for (const Log& log : study.logs) {
      high = std::max(high, log.measured.col(j).maxCoeff());
      low = std::min(low, log.measured.col(j).minCoeff());
    }
    Clipping clip{j, std::max(std::abs(high), std::abs(low)), {}};
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

Knocks find_knocks(const Case& study, const Signals& left) {
  const EffectKind& kind = *find_effect("loose_load");
  ToolModel moving = study.simulator.model;
  moving.inertial = ToolModel::Inertial::kLinear;
  const auto levels = noise_level(study, left);
  Knocks best;
  double most = 0.0;
  for (std::size_t j = 0; j < study.channels.size(); ++j) {
    const int axis = study.channels[j];
    if (axis > 2) continue;
    int right = 0, wrong = 0;
    double strength = 0.0, against = 0.0;
    std::vector<double> gaps, slugs;
    std::vector<Span> spans;
    const auto heard = alike_spikes(left, levels, static_cast<Index>(j), study.dt());
    for (std::size_t k = 0; k < study.logs.size(); ++k) {
      const Motion& motion = study.logs[k].motion;
      if (motion.a_B.rows() != motion.samples()) return {};
      const Eigen::VectorXd field = felt_acceleration(moving, motion).col(axis);
      const Eigen::VectorXd r = left[k].col(static_cast<Index>(j));
      for (const Spike& spike : heard[k]) {
        const Index i = spike.at;
        const bool along = spike.height * field(i) > 0.0;
        (along ? right : wrong)++;
        strength += spike.height * spike.height;
        if (!along) against += spike.height * spike.height;
        spans.push_back({k, motion.t(i) - 0.5, motion.t(i) + 0.12});
        const Index from = turned_before(field, i, study.dt());
        if (from < 0 || !along) continue;
        double speed = 0.0, way = 0.0, momentum = 0.0;
        for (Index s = from; s <= i; ++s) {
          speed += field(s) * study.dt();
          way += speed * study.dt();
        }
        const Index reach = std::max<Index>(1, std::llround(0.02 / study.dt()));
        for (Index s = std::max<Index>(0, i - reach); s < std::min(r.size(), i + reach + 1); ++s) {
          momentum += (r(s) - spike.base) * study.dt();
        }
        gaps.push_back(std::abs(way));
        if (std::abs(speed) > 1e-6) slugs.push_back(momentum / speed);
      }
    }
    // Few may be chance unless they are loud; of many some may be noise.
    const double knocks = right + wrong, loudness = std::sqrt(strength / std::max(1.0, knocks));
    const bool lawful = against <= kMostWrong * strength && (knocks >= kMany || loudness >= kLoud);
    const bool certain = right - wrong >= kSignificant * std::sqrt(knocks);
    if (right < 3 || !(lawful || certain) || strength < most || slugs.size() < 2) continue;
    most = strength;
    Member member = make_member(kind, kind.fits[0],
                                admitted_axes(AxisRule::kSensor)[static_cast<std::size_t>(axis)],
                                false, Eigen::VectorXd::Constant(1, median(gaps)));
    member.amplitudes(0) = std::max(1e-6, median(slugs));
    member.fixed = true;
    const auto spread = [](const std::vector<double>& v) {
      const double centre = median(v);
      std::vector<double> away;
      for (const double x : v) away.push_back(std::abs(x - centre));
      return 1.86 * median(away) / std::sqrt(static_cast<double>(v.size()));  // of a median
    };
    member.fixed_deviation = Eigen::Vector2d(spread(slugs), spread(gaps));
    best.member = member;
    best.spans = spans;
  }
  return best;
}

std::optional<Member> find_fast_hum(const Case& study, const Signals& left,
                                    const std::vector<Floor>& floors) {
  const double top = 0.49 / study.dt();
  const double from = kFast * study.motion_hz;
  if (top < from || study.lowpass_hz > 0.0) return std::nullopt;
  std::vector<Peak> peaks;
  for (Index j = 0; j < study.channel_count(); ++j) {
    for (const Peak& p : spectral_lines(study, left, floors, from, top, j, 1)) peaks.push_back(p);
  }
  const auto strongest = std::max_element(peaks.begin(), peaks.end(),
                                          [](auto& a, auto& b) { return a.ratio < b.ratio; });
  if (strongest == peaks.end() || strongest->ratio < 20.0) return std::nullopt;

  const Index channels = study.channel_count();
  Eigen::MatrixXd sine(1, channels), cosine(1, channels);
  double samples = 0.0;
  for (const auto& r : left) samples += static_cast<double>(r.rows());
  // Gain in chi-square of the line at hz, with its amplitudes.
  const auto gain_at = [&](double hz) {
    sine.setZero();
    cosine.setZero();
    for (std::size_t k = 0; k < left.size(); ++k) {
      const Eigen::ArrayXd angle = 2.0 * std::numbers::pi * hz * study.logs[k].motion.t.array();
      sine += angle.sin().matrix().transpose() * left[k];
      cosine += angle.cos().matrix().transpose() * left[k];
    }
    sine *= 2.0 / samples;
    cosine *= 2.0 / samples;
    double gain = 0.0;
    for (Index j = 0; j < channels; ++j) {
      const double density = floors[static_cast<std::size_t>(j)].density(hz);
      gain += 0.5 * samples * (sine(0, j) * sine(0, j) + cosine(0, j) * cosine(0, j)) / density;
    }
    return gain;
  };
  const double longest = longest_seconds(study);
  const Eigen::VectorXd hz = simplex_search(
      [&](const Eigen::VectorXd& f) { return -gain_at(f(0)); },
      Eigen::VectorXd::Constant(1, strongest->hz), Eigen::VectorXd::Constant(1, 0.2 / longest), 40);
  const double gain = gain_at(hz(0));
  const EffectKind& kind = *find_effect("hum");
  Member member = make_member(kind, kind.fits[0], "", study.has_torque(), hz);
  if (gain - 10.0 * member.parameters() < 30.0) return std::nullopt;
  const Index half = member.amplitudes.size() / 2;
  member.amplitudes.setZero();
  member.fixed_deviation.setZero(member.amplitudes.size() + 1);
  for (Index j = 0; j < channels; ++j) {
    const int c = study.channels[static_cast<std::size_t>(j)];
    member.amplitudes(c) = sine(0, j);
    member.amplitudes(half + c) = cosine(0, j);
    const double density = floors[static_cast<std::size_t>(j)].density(hz(0));
    member.fixed_deviation(c) = member.fixed_deviation(half + c) =
        std::sqrt(2.0 * density / samples);
  }
  // Rife and Boorstyn 1974: of the frequency, from the gain as signal-to-noise ratio.
  member.fixed_deviation(member.amplitudes.size()) =
      std::sqrt(3.0 / std::max(gain, 1.0)) / (std::numbers::pi * longest);
  member.fixed = true;
  return member;
}

}  // namespace dcnn
