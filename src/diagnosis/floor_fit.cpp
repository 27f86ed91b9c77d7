// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/floor_fit.h"

#include <algorithm>

#include "core/elementary.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/noise_shapes.h"

namespace dcnn {
namespace {

constexpr double kUpperPart = 1.4;  // of the lowest frequency of the quiet band: its upper part

/// The first bin of a band's upper part.
Index upper_part(const Eigen::VectorXd& hz) {
  Index upper = 0;
  while (upper < hz.size() && hz(upper) < kUpperPart * hz(0)) ++upper;
  return upper;
}

bool has_colour(const Floor& floor) {
  return floor.coloured + floor.filtered + floor.flicker > 0.0;
}

}  // namespace

Whittle fit_level(const Eigen::VectorXd& density, const Eigen::VectorXd& shape, double windows) {
  Whittle fit;
  fit.level = density.cwiseQuotient(shape).mean();
  const auto n = static_cast<double>(density.size());
  fit.likelihood =
      -windows * (shape.array().unaryExpr([](double d) { return elementary::log(d); }).sum() +
                  n * (elementary::log(fit.level) + 1.0));
  return fit;
}

Floor fit_floor(const Eigen::VectorXd& density, const Eigen::VectorXd& hz, double dt,
                double windows, bool flat, const std::function<bool(const Floor&)>& is_refuted) {
  Floor best;
  const Whittle white = fit_level(density, Eigen::VectorXd::Ones(density.size()), windows);
  best.white = white.level;
  if (flat) return best;
  double most = white.likelihood + prior::kColour;
  // Colour must show in the upper part of the band too: motion may leak into its lowest bins.
  const Index upper = upper_part(hz);
  if (upper == hz.size()) return best;
  const auto above = [&](const Eigen::VectorXd& v) {
    return Eigen::VectorXd(v.tail(v.size() - upper));
  };
  const Eigen::VectorXd density_above = above(density);
  const double white_above =
      fit_level(density_above, Eigen::VectorXd::Ones(density_above.size()), windows).likelihood;
  /// Takes noise of this shape if it is likelier, and no more than what is left below the motion's
  /// edge too; `floor_of` makes it of its level.
  const auto consider = [&](const Eigen::VectorXd& shape, const auto& floor_of) {
    const Whittle fit = fit_level(density, shape, windows);
    if (fit.likelihood <= most) return;
    const Whittle upper_fit = fit_level(density_above, above(shape), windows);
    if (upper_fit.likelihood <= white_above + prior::kColourAbove) return;
    Floor floor = floor_of(fit.level);
    floor.dt = dt;
    if (is_refuted(floor)) return;
    most = fit.likelihood;
    best = std::move(floor);
  };
  for (const double rho : {0.3, 0.4,   0.5,  0.57, 0.64, 0.7,  0.75, 0.8,   0.83,  0.86, 0.88,
                           0.9, 0.915, 0.93, 0.94, 0.95, 0.96, 0.97, 0.978, 0.985, 0.99, 0.995}) {
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
  // A filter is the last that is asked for, likelier than the others by as much again; an octave of
  // its plateau must be seen, for any colour falls somewhere.
  most += prior::kColour;
  for (double cutoff = 2.0 * hz(0); cutoff < 0.8 * top; cutoff *= 1.15) {
    for (const double share : {0.0, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3}) {
      const Eigen::VectorXd shape =
          hz.unaryExpr([&](double f) { return share + (1.0 - share) * filter_shape(cutoff, f); });
      consider(shape, [&](double level) {
        return Floor{
            .white = share * level, .filtered = (1.0 - share) * level, .filter_hz = cutoff};
      });
    }
  }
  return best;
}

bool share_colours(const std::vector<QuietBand>& bands, std::vector<Floor>& floors) {
  const std::vector<Floor> own = floors;
  bool any = false;
  for (std::size_t j = 0; j < own.size(); ++j) {
    const QuietBand& band = bands[j];
    if (has_colour(own[j]) || band.density.size() == 0) continue;
    const Index upper = upper_part(band.hz), above = band.hz.size() - upper;
    if (above == 0) continue;
    const auto gain = [&](const Eigen::VectorXd& shape, Index bins) {
      const Eigen::VectorXd density = band.density.tail(bins), white = Eigen::VectorXd::Ones(bins);
      return fit_level(density, shape.tail(bins), band.windows).likelihood -
             fit_level(density, white, band.windows).likelihood;
    };
    double most = prior::kColour;
    for (const Floor& other : own) {
      if (!has_colour(other)) continue;
      const Eigen::VectorXd shape = band.hz.unaryExpr([&](double f) { return other.density(f); });
      const double here = gain(shape, band.hz.size());
      if (here <= most || gain(shape, above) <= prior::kColourAbove) continue;
      most = here;
      any = true;
      floors[j] = other;
      floors[j].amplify(fit_level(band.density, shape, band.windows).level);
      floors[j].lines = own[j].lines;
      floors[j].source = own[j].source + ", its colour that of another channel";
    }
  }
  return any;
}

}  // namespace dcnn
