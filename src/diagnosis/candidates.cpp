// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/candidates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/gear_order.h"
#include "diagnosis/position_bins.h"
#include "diagnosis/spectral_lines.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr Index kFewestOrderBins = 16;  // of a position, beside four numbers
constexpr Index kOrderStride = 5;       // samples, which tell an order as well as all

/// Every combination of the seeds of a form's shapes on an axis.
std::vector<Eigen::VectorXd> seed_grid(const Case& study, const EffectFit& form,
                                       const std::string& axis) {
  const double scale = seed_scale(axis);
  std::vector<Eigen::VectorXd> grid{Eigen::VectorXd(0)};
  for (const ShapeParameter& shape : form.shapes) {
    std::vector<Eigen::VectorXd> longer;
    for (const auto& point : grid) {
      for (const double seed : shape.seeds) {
        Eigen::VectorXd p(point.size() + 1);
        p << point, scale * unit_of(study, shape) * seed;
        longer.push_back(p);
      }
    }
    grid = std::move(longer);
  }
  return grid;
}

/// What is left along n, collected in bins of the angle.
PositionBins bin_by_angle(const Case& study, const Signals& left, const std::string& axis) {
  constexpr double kAngleBin = 0.0025, kMostAngleBins = 4000.0;  // rad, of a tool: orders to 200
  double low = 1e300, high = -1e300;
  const AngleAxis at = angle_axis(axis);
  for (const Log& log : study.logs) {
    low = std::min(low, log.motion.euler.col(at.angle).minCoeff());
    high = std::max(high, log.motion.euler.col(at.angle).maxCoeff());
  }
  PositionBins bins(
      low, high,
      study.axis ? position_bin(study) : std::max(kAngleBin, (high - low) / kMostAngleBins));
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Motion& motion = study.logs[k].motion;
    const Eigen::MatrixXd n_S = direction_of(at.axis, motion);
    for (Index i = 0; i < motion.samples(); i += kOrderStride) {
      double along = 0.0, norm = 0.0;
      for (std::size_t j = 0; j < study.channels.size(); ++j) {
        if (study.channels[j] > 2) continue;
        const double n = n_S(i, study.channels[j]);
        along += n * left[k](i, static_cast<Index>(j));
        norm += n * n;
      }
      bins.add(motion.euler(i, at.angle), along, norm);
    }
  }
  return bins;
}

void add_cogging(const Scan& scan, const Signals& left, std::vector<Member>& list) {
  const Case& study = scan.setting().study;
  const EffectKind& kind = *find_effect("cogging");
  for (const auto& axis : axes_of(study, kind)) {
    const PositionBins bins = bin_by_angle(study, left, axis);
    if (bins.size() < kFewestOrderBins || bins.count.maxCoeff() <= 0.0) continue;
    const double highest = highest_order(study, kind.fits[0].shapes[0], bins.width);
    const double least = least_order(study, angle_axis(axis).angle);
    const double order = best_order(bins, least, highest);
    if (order <= 0.0) continue;
    list.push_back(
        make_member(study, kind, kind.fits[0], axis, Eigen::VectorXd::Constant(1, order)));
    list.back().least_shapes(0) = least;
    list.back().most_shapes(0) = highest;
  }
}

void add_resonances(const Scan& scan, const Signals& left, const std::vector<Floor>& floors,
                    std::vector<Member>& list) {
  const Case& study = scan.setting().study;
  const EffectKind& kind = *find_effect("flexible_resonance");
  const EffectFit& form =
      *std::find_if(kind.fits.begin(), kind.fits.end(), [&](const EffectFit& f) {
        return f.use == (study.axis ? EffectFit::Use::kMachines : EffectFit::Use::kTools);
      });
  // Above half the rate of the blocks a mode shows its stiffness alone.
  const double top = std::min(0.25 / study.dt(), 0.5 / scan.setting().whitener.block_seconds());
  for (std::size_t j = 0; j < study.channels.size(); ++j) {
    if (study.channels[j] > 2) continue;
    auto peaks = spectral_lines(study, left, floors, 1.5, top, static_cast<Index>(j), 3);
    for (const double hz : {4.0, 8.0, 14.0}) peaks.push_back({hz, 0.0});
    for (const Peak& peak : peaks) {
      for (const double zeta : form.shapes[1].seeds) {
        list.push_back(make_member(
            study, kind, form,
            admitted_axes(AxisRule::kSensor)[static_cast<std::size_t>(study.channels[j])],
            Eigen::Vector2d(std::min(peak.hz, top), zeta)));
        list.back().most_shapes(0) = top;
      }
    }
  }
}

/// How far a line must stand out where the tool itself moves: there it may be a small error of the
/// motion's own.
double least_excess_in_motion(double terms) { return 60.0 + 3.0 * terms; }

/// Whether a signal has a line of its own near this frequency.
bool has_line(const Case& study, const Signals& signals, const std::vector<Floor>& floors,
              double hz) {
  const auto lines = common_lines(study, signals, floors, hz - 0.3, hz + 0.3, 1);
  return !lines.empty() && lines.front().ratio > 100.0;
}

/// The sense of an axis' velocity, whose lines are those of friction.
Signals senses(const Case& study) {
  Signals signals;
  for (const Log& log : study.logs)
    signals.push_back(log.motion.v_B.col(0).array().sign().matrix());
  return signals;
}

/// Share of sines of any phase at this frequency that is linear in what moves, or on an axis in the
/// even and odd laws of it, whose harmonics a repeated motion has.
double share_in_motion(const Case& study, double hz) {
  double explained = 0.0, power = 0.0;
  for (const Log& log : study.logs) {
    const Motion& motion = log.motion;
    Eigen::MatrixXd moves(motion.samples(), 0);
    for (const Eigen::MatrixXd* part : {&motion.euler, &motion.w_S, &motion.v_B, &motion.a_B}) {
      if (part->rows() == motion.samples()) moves = appended(moves, *part);
    }
    if (study.axis && motion.v_B.rows() == motion.samples()) {
      const Eigen::ArrayXd q = motion.euler.col(0), v = motion.v_B.col(0);
      Eigen::MatrixXd laws(motion.samples(), 5);
      laws << q.square(), q.cube(), v.square(), v.sign(), v.sign() * q;
      moves = appended(moves, laws);
    }
    Eigen::MatrixXd waves(motion.samples(), 2);
    for (Index i = 0; i < motion.samples(); ++i) {
      const double turns = 2.0 * std::numbers::pi * hz * motion.t(i);
      waves.row(i) << elementary::cos(turns), elementary::sin(turns);
    }
    waves.rowwise() -= waves.colwise().mean().eval();
    moves.rowwise() -= moves.colwise().mean().eval();
    explained += (orthonormal(moves).transpose() * waves).squaredNorm();
    power += waves.squaredNorm();
  }
  return explained / std::max(power, 1e-300);
}

void add_hum(const Scan& scan, const Signals& left, const std::vector<Floor>& floors,
             std::vector<Member>& list) {
  constexpr int kLines = 4;
  constexpr std::size_t kTried = 2;
  const Case& study = scan.setting().study;
  const EffectKind& kind = *find_effect("hum");  // a periodic motion has lines of its own
  const Signals prediction = scan.chain().prediction();
  const Signals sense = study.axis ? senses(study) : Signals();
  std::size_t tried = 0;
  for (const auto& line : common_lines(study, left, floors, 0.3, 0.49 / study.dt(), kLines)) {
    if (!line.stands_out() || tried == kTried) break;
    const bool in_motion = has_line(study, prediction, floors, line.hz) ||
                           (study.axis && has_line(study, sense, floors, line.hz));
    if (in_motion && (line.excess < least_excess_in_motion(line.terms) ||
                      share_in_motion(study, line.hz) > prior::kMostlyMotion)) {
      continue;
    }
    list.push_back(
        make_member(study, kind, kind.fits[0], "", Eigen::VectorXd::Constant(1, line.hz)));
    ++tried;
  }
}

bool has_temperature(const Case& study) {
  return std::all_of(study.logs.begin(), study.logs.end(), [](const Log& log) {
    return log.motion.temperature.size() == log.motion.samples();
  });
}

/// The recordings' own temperatures: an offset that follows them turns its sign at any.
std::vector<Eigen::VectorXd> reference_temperatures(const Case& study) {
  double low = 1e300, high = -1e300;
  for (const Log& log : study.logs) {
    low = std::min(low, log.motion.temperature.minCoeff());
    high = std::max(high, log.motion.temperature.maxCoeff());
  }
  std::vector<Eigen::VectorXd> seeds;
  for (const double share : {-2.0, 0.0, 0.5, 1.0, 3.0}) {
    seeds.push_back(Eigen::VectorXd::Constant(1, low + share * (high - low)));
  }
  return seeds;
}

}  // namespace

double seed_scale(const std::string& axis) {
  constexpr double kPerArm = 5.0;  // 1/m
  return axis.starts_with("w_") ? kPerArm : 1.0;
}

bool is_listed(const Case& study, const EffectKind& kind) {
  if (study.without.effects.count(kind.name) > 0) return false;
  using Subject = EffectKind::Subject;
  if (!study.axis) return kind.subject == Subject::kAny || kind.subject == Subject::kTools;
  if (kind.subject == Subject::kTurning) {
    return study.axis->axis().position_unit == "rad" && study.axis->system.arm.is_null();
  }
  return kind.stage != Stage::kTool && kind.subject != Subject::kTools;
}

std::vector<std::string> axes_of(const Case& study, const EffectKind& kind) {
  if (kind.axis == AxisRule::kNone) return {""};
  if (!study.axis) {
    std::vector<std::string> axes = admitted_axes(kind.axis);
    const bool aligned = study.simulator.model.R_ES().isIdentity(1e-9);
    // Where the sensor sits straight on the flange, an axis of the tool is one of the sensor.
    if (kind.axis == AxisRule::kAngle && aligned) {
      std::erase_if(axes, [](const std::string& a) { return a.find("tool_") != a.npos; });
    }
    return axes;
  }
  return {kind.axis == AxisRule::kLine    ? "base_x"
          : kind.axis == AxisRule::kAngle ? "alpha:base_x"
                                          : "sensor_x"};
}

std::vector<Member> candidates(const Scan& scan, const Signals& left,
                               const std::vector<Floor>& floors) {
  const Case& study = scan.setting().study;
  std::vector<Member> list;
  for (const EffectKind* kind : effect_kinds()) {
    const bool own_test = kind->interval == IntervalRule::kRequired ||
                          kind->interval == IntervalRule::kOnset ||
                          kind->stage == Stage::kSaturation || kind->stage == Stage::kQuantisation;
    if (own_test || !is_listed(study, *kind) || !is_testable(study, *kind)) continue;
    for (const EffectFit& form : kind->fits) {
      const bool follows = !form.shapes.empty() && std::string(form.shapes[0].name) == "t_ref";
      if (follows && !has_temperature(study)) continue;
      if (form.amplitudes > 1 && is_in_base(study, *kind)) continue;
      if (!is_tried(study, form)) continue;
      for (const auto& axis : axes_of(study, *kind)) {
        const auto grid = follows ? reference_temperatures(study) : seed_grid(study, form, axis);
        for (const auto& shapes : grid) {
          list.push_back(make_member(study, *kind, form, axis, shapes));
        }
      }
    }
  }
  if (study.is_static()) return list;
  add_cogging(scan, left, list);
  add_gear_frictions(study, left, list);
  add_resonances(scan, left, floors, list);
  add_hum(scan, left, floors, list);
  std::erase_if(list, [&](const Member& m) { return !is_listed(study, *m.kind); });
  return list;
}

std::vector<Member> driven_candidates(const Case& study, const std::vector<Member>& plain) {
  std::vector<Member> list;
  const auto add = [&](const EffectKind& kind, const EffectFit& form, const std::string& axis,
                       const Eigen::VectorXd& own) {
    Eigen::VectorXd shapes(own.size() + 1);
    shapes << own, 0.0;
    for (const Case::Driver& driver : study.drivers) {
      list.push_back(make_driven(study, kind, form, axis, shapes, driver));
    }
  };
  for (const Member& m : plain) {
    if (m.kind->strength == nullptr || m.form->amplitudes != 1 || m.driver) continue;
    add(*m.kind, *m.form, m.axis, m.shapes.head(m.own_shapes()));
  }
  for (const EffectKind* kind : effect_kinds()) {
    if (!is_listed(study, *kind) || !is_testable(study, *kind)) continue;
    for (const EffectFit& form : kind->fits) {
      // The offset of a tool has three components, and follows a temperature alone (thermal_drift).
      const bool vector = kind->axis == AxisRule::kNone && !study.axis;
      if (form.use != EffectFit::Use::kDriven || vector) continue;
      for (const auto& axis : axes_of(study, *kind)) {
        for (const auto& shapes : seed_grid(study, form, axis)) add(*kind, form, axis, shapes);
      }
    }
  }
  return list;
}

}  // namespace dcnn
