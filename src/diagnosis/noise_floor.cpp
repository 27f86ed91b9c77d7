#include "diagnosis/noise_floor.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/linear_algebra.h"
#include "dcnn/data/fourier.h"
#include "dcnn/data/rotation.h"
#include "diagnosis/median.h"

namespace dcnn {
namespace {

constexpr double kColourGain = 12.0;  // of the log-likelihood, before noise is called coloured
constexpr double kUpperPart = 1.4;    // of the lowest frequency of the quiet band: its upper part
constexpr double kColourAbove = 3.0;  // of the log-likelihood there
constexpr Index kWindow = 1024;       // samples of one periodogram
constexpr Index kShortestWindow = 64;
constexpr double kSlowest = 0.02;  // Hz: flicker noise is taken for flat below
constexpr double kLeastOfDifferences = 1e-6;
constexpr Index kFewestBins = 12;  // below this the quiet band says nothing

/// Shape of AR(1) noise of unit variance.
double ar_shape(double rho, double hz, double dt) {
  return (1.0 - rho * rho) /
         (1.0 - 2.0 * rho * std::cos(2.0 * std::numbers::pi * hz * dt) + rho * rho);
}

/// Periodograms of windows of one signal, (bins, windows), scaled so that white noise of variance
/// s^2 has mean s^2. Windows never cross a gap.
struct Periodograms {
  Eigen::MatrixXd power;
  Eigen::VectorXd hz;
};

/// Samples of a window of which segments long enough hold half of the recordings.
Index window_of(const Case& study) {
  Index longest = 0;
  for (Index n = kWindow; n >= kShortestWindow; n /= 2) {
    Index all = 0, held = 0;
    for (const Log& log : study.logs) {
      for (const Segment& s : log.motion.segments) {
        all += s.size();
        if (s.size() >= n) held += s.size();
        longest = std::max(longest, s.size());
      }
    }
    if (2 * held >= all) return n;
  }
  return std::max<Index>(16, std::min(longest, kShortestWindow));
}

/// Variance of white noise with these second differences.
double variance_of_differences(const Signals& signals, Index channel) {
  double sum = 0.0, count = 0.0;
  for (const auto& x : signals) {
    for (Index i = 2; i < x.rows(); ++i, ++count) {
      const double d = x(i, channel) - 2.0 * x(i - 1, channel) + x(i - 2, channel);
      sum += d * d / 6.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

Periodograms periodograms(const Case& study, const Signals& signals, Index channel) {
  const Index n = window_of(study);
  const Eigen::VectorXd taper =
      (1.0 - (Eigen::ArrayXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5) * 2.0 *
              std::numbers::pi / static_cast<double>(n))
                 .cos())
          .matrix() *
      0.5;
  const double power = taper.squaredNorm();
  Periodograms result;
  const Index bins = n / 2 + 1;
  result.hz = Eigen::VectorXd::LinSpaced(bins, 0.0, static_cast<double>(bins - 1)) /
              (static_cast<double>(n) * study.dt());
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    for (const Segment& s : study.logs[k].motion.segments) {
      for (Index begin = s.begin; begin + n <= s.end; begin += n) {
        Eigen::VectorXd x = signals[k].col(channel).segment(begin, n);
        x.array() -= x.mean();
        columns.push_back(fourier(x.cwiseProduct(taper)).cwiseAbs2() / power);
      }
    }
  }
  result.power.resize(bins, static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    result.power.col(static_cast<Index>(k)) = columns[k];
  }
  return result;
}

/// Median over windows of each bin, as an estimate of the density: the upper middle of n values of
/// an exponential distribution is on the average sum_{i=0}^{n/2} 1/(n-i) of its mean (ln 2 for
/// many).
/// `coarse`: readings on a coarse lattice are noisy near the middle between two values and still
/// elsewhere, so that most windows hold less noise than all do together.
Eigen::VectorXd density_of(const Periodograms& p, bool coarse = false) {
  if (coarse && p.power.cols() > 0) return p.power.rowwise().mean();
  Eigen::VectorXd density(p.power.rows());
  double expected = 0.0;
  for (Index i = 0; p.power.cols() > 0 && i <= p.power.cols() / 2; ++i)
    expected += 1.0 / double(p.power.cols() - i);
  for (Index i = 0; i < density.size(); ++i) {
    std::vector<double> values(static_cast<std::size_t>(p.power.cols()));
    for (Index k = 0; k < p.power.cols(); ++k) values[static_cast<std::size_t>(k)] = p.power(i, k);
    density(i) = values.empty() ? 0.0 : median(values) / expected;
  }
  return density;
}

struct Whittle {
  double level = 0.0, likelihood = 0.0;
};

/// Lines replaced by the level beside them.
Eigen::VectorXd without_lines(const Eigen::VectorXd& density) {
  constexpr Index kBeside = 10;  // bins
  Eigen::VectorXd smooth = density;
  for (Index i = 0; i < density.size(); ++i) {
    const Index first = std::max<Index>(0, i - kBeside);
    const Index last = std::min(density.size(), i + kBeside + 1);
    const double level = median({density.data() + first, density.data() + last});
    smooth(i) = density(i) < 3.0 * level ? density(i) : level;
  }
  return smooth;
}

/// The level of noise of this shape, and its log-likelihood up to a constant.
Whittle fit_level(const Eigen::VectorXd& density, const Eigen::VectorXd& shape, double windows) {
  Whittle fit;
  fit.level = density.cwiseQuotient(shape).mean();
  const auto n = static_cast<double>(density.size());
  fit.likelihood = -windows * (shape.array().log().sum() + n * (std::log(fit.level) + 1.0));
  return fit;
}

Floor fit_floor(const Eigen::VectorXd& density, const Eigen::VectorXd& hz, double dt,
                double windows, bool flat) {
  Floor best;
  const Whittle white = fit_level(density, Eigen::VectorXd::Ones(density.size()), windows);
  best.white = white.level;
  if (flat) return best;
  double most = white.likelihood + kColourGain;
  // Colour must show in the upper part of the band too: motion may leak into its lowest bins.
  Index upper = 0;
  while (upper < hz.size() && hz(upper) < kUpperPart * hz(0)) ++upper;
  const auto above = [&](const Eigen::VectorXd& v) {
    return Eigen::VectorXd(v.tail(v.size() - upper));
  };
  const Eigen::VectorXd density_above = above(density);
  const double white_above =
      fit_level(density_above, Eigen::VectorXd::Ones(density_above.size()), windows).likelihood;
  /// Takes noise of this shape if it is likelier; `floor_of` makes it of its level.
  const auto consider = [&](const Eigen::VectorXd& shape, const auto& floor_of) {
    const Whittle fit = fit_level(density, shape, windows);
    if (fit.likelihood <= most) return;
    const Whittle upper_fit = fit_level(density_above, above(shape), windows);
    if (upper_fit.likelihood <= white_above + kColourAbove) return;
    most = fit.likelihood;
    best = floor_of(fit.level);
  };
  for (const double rho : {0.3, 0.5, 0.7, 0.8, 0.86, 0.9, 0.93, 0.95, 0.97, 0.985, 0.995}) {
    for (const double share : {0.0, 0.01, 0.03, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85}) {
      const Eigen::VectorXd shape =
          hz.unaryExpr([&](double f) { return share + (1.0 - share) * ar_shape(rho, f, dt); });
      consider(shape, [&](double level) {
        return Floor{.white = share * level, .coloured = (1.0 - share) * level, .rho = rho};
      });
    }
  }
  const double top = 0.5 / dt;
  for (const double share : {0.0, 0.03, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8}) {
    const Eigen::VectorXd shape =
        hz.unaryExpr([&](double f) { return share + (1.0 - share) * top / f; });
    consider(shape, [&](double level) {
      return Floor{.white = share * level, .flicker = (1.0 - share) * level * top};
    });
  }
  return best;
}

}  // namespace

double Floor::deviation() const {
  if (lowpass_hz == 0.0 && flicker == 0.0) return std::sqrt(white + coloured);
  constexpr int kPoints = 8192;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) sum += density((i + 0.5) / kPoints * 0.5 / dt);
  return std::sqrt(sum / kPoints);
}

double Floor::density(double hz) const {
  const double plain = white + (coloured > 0.0 ? coloured * ar_shape(rho, hz, dt) : 0.0) +
                       flicker / std::max(hz, kSlowest);
  if (lowpass_hz == 0.0) return plain;
  const double gain = 1.0 / (1.0 + std::pow(hz / lowpass_hz, 8.0));  // Butterworth, there and back
  return plain * gain * gain;
}

double Floor::pose_density(double hz, double cutoff_hz) const {
  if (cutoff_hz <= 0.0) return 0.0;
  const double w = 2.0 * std::numbers::pi * hz;
  double rung = 1.0;
  for (const Mode& mode : modes) {
    const double r = hz / mode.hz;
    const std::complex<double> below(1.0 - r * r, 2.0 * mode.zeta * r);
    rung *= std::norm(1.0 + mode.fraction * (1.0 / below - 1.0));
  }
  return rung * (static_part + moving_part * w * w * w * w) / (1.0 + std::pow(hz / cutoff_hz, 8.0));
}

double quiet_band(const Case& study) {
  const double most = study.motion_hz > 20.0 ? 0.35 : 0.2;  // of the rate
  return std::min(study.motion_hz, most / study.dt());
}

std::vector<Floor> noise_floor(const Case& study, const Signals& residual,
                               const std::vector<Eigen::VectorXd>& levels) {
  if (study.is_static()) return floor_at_rest(study, residual);
  Signals even;
  for (std::size_t k = 0; k < residual.size(); ++k) {
    even.push_back(levels[k].cwiseInverse().asDiagonal() * residual[k]);
  }
  const double dt = study.dt(), from = quiet_band(study), to = 0.49 / dt;
  std::vector<Floor> floors;
  for (Index channel = 0; channel < study.channel_count(); ++channel) {
    const Periodograms p = periodograms(study, even, channel);
    const Eigen::VectorXd density = density_of(p, study.rounding_step > 0.0);
    std::vector<Index> quiet;
    for (Index i = 0; i < p.hz.size(); ++i) {
      if (p.hz(i) >= from && p.hz(i) <= to) quiet.push_back(i);
    }
    Floor floor;
    if (static_cast<Index>(quiet.size()) >= kFewestBins && p.power.cols() > 0) {
      floor = fit_floor(without_lines(density(quiet)), p.hz(quiet), dt,
                        static_cast<double>(p.power.cols()), study.without.coloured_floor);
      floor.source = "spectrum of the residual above " +
                     std::to_string(static_cast<int>(std::lround(from))) + " Hz";
    }
    // Without a quiet band, or where most windows hold one value that is read again and again.
    const double differences = variance_of_differences(even, channel);
    if (floor.white + floor.coloured + floor.flicker < kLeastOfDifferences * differences) {
      floor = Floor{.white = differences, .source = "second differences of the residual"};
    }
    floor.lowpass_hz = study.lowpass_hz;
    floor.dt = dt;
    floors.push_back(floor);
  }
  return floors;
}

void add_pose_noise(const Case& study, std::vector<Floor>& floors) {
  if (study.is_static() || study.axis) return;
  const auto quiet_density = [&](const std::vector<std::string>& names) {
    double most = 0.0;
    for (const auto& name : names) {
      Signals pose;
      for (const Log& log : study.logs) {
        if (!log.recording.has(name)) return 0.0;
        Eigen::VectorXd x = log.recording.column(name);
        if (names.size() == 3 && name != "x" && name != "y" && name != "z") unwrap(x);
        pose.emplace_back(x);
      }
      const Periodograms p = periodograms(study, pose, 0);
      const Eigen::VectorXd density = density_of(p);
      std::vector<double> quiet;
      for (Index i = 0; i < p.hz.size(); ++i) {
        if (p.hz(i) >= quiet_band(study) && p.hz(i) <= 0.49 / study.dt()) {
          quiet.push_back(density(i));
        }
      }
      if (!quiet.empty()) most = std::max(most, median(quiet));
    }
    return most;
  };
  const ToolModel& tool = study.simulator.model;
  const double position = quiet_density({"x", "y", "z"});
  const bool angles = study.logs.front().recording.has("alpha");
  const double angle = angles ? quiet_density({"alpha", "beta", "gamma"})
                              : 4.0 * quiet_density({"qw", "qx", "qy", "qz"});
  const double lever = tool.mass * tool.com.norm(), weight = tool.mass * tool.gravity.norm();
  const bool moving = tool.inertial != ToolModel::Inertial::kNone;
  for (std::size_t j = 0; j < floors.size(); ++j) {
    const bool force = study.channels[j] < 3;
    const double arm = force ? 1.0 : tool.com.norm();
    floors[j].static_part = weight * weight * angle * arm * arm;
    floors[j].moving_part =
        moving ? (tool.mass * tool.mass * position + lever * lever * angle) * arm * arm : 0.0;
  }
}

}  // namespace dcnn
