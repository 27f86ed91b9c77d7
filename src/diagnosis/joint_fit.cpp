// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "diagnosis/base_errors.h"
#include "diagnosis/beginning.h"
#include "diagnosis/passed_base.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr int kMostSteps = 12;
constexpr double kSettled = 0.02;   // of chi-square: far below what decides anything
constexpr double kStraight = 1e-4;  // of chi-square: how far a step may end from its tangent

/// One number of one member, on the scale it is searched on.
struct Coordinate {
  std::size_t member;
  bool is_shape;
  Index index;
};

std::vector<Coordinate> coordinates_of(const std::vector<Member>& members) {
  std::vector<Coordinate> list;
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (members[m].coordinates() == 0) continue;
    for (Index i = 0; i < members[m].amplitudes.size(); ++i) list.push_back({m, false, i});
    for (Index i = 0; i < members[m].shapes.size(); ++i) list.push_back({m, true, i});
  }
  return list;
}

void move(Member& member, const Coordinate& c, double step) {
  if (!c.is_shape) {
    double& amplitude = member.amplitudes(c.index);
    amplitude = member.form->bounded(amplitude + step);
    if (member.form->rising) {
      member.amplitudes(1) = std::max(member.amplitudes(0), member.amplitudes(1));
    }
    return;
  }
  const ShapeParameter& shape = member.shape(c.index);
  member.shapes(c.index) =
      from_search_scale(member, c.index, search_scale(shape, member.shapes(c.index)) + step);
}

/// What the size of a second amplitude may be (EffectFit::most_ratio); infinity for most effects.
double most_of_second(const Case& study, const Member& member) {
  if (study.axis || member.form->most_ratio == kInfinity) return kInfinity;
  return member.form->most_ratio * std::abs(member.amplitudes(0));
}

void hold_ratio(const Case& study, Member& member) {
  const double most = most_of_second(study, member);
  if (most < kInfinity) member.amplitudes(1) = std::clamp(member.amplitudes(1), -most, most);
}

/// A shape may not leap out of the region its derivative tells of: a factor of e, or a part of its
/// range.
double longest_step(const std::vector<Member>& members, const Coordinate& c) {
  if (!c.is_shape) return kInfinity;
  const ShapeParameter& shape = members[c.member].shape(c.index);
  return shape.low > 0.0 ? 1.0 : std::max(1.0, 0.15 * (shape.high - shape.low));
}

/// A difference step: upwards, but for a shape at its upper bound.
double difference_step(const Case& study, const std::vector<Member>& members, const Coordinate& c) {
  const Member& member = members[c.member];
  if (!c.is_shape) return std::max(1e-3 * std::abs(member.amplitudes(c.index)), 1e-5);
  if (member.shape(c.index).peak == ShapeParameter::Peak::kLine)
    return 0.003 / (span_seconds(study) * member.shapes(c.index));
  return member.shapes(c.index) > 0.995 * member.most_shapes(c.index) ? -1e-3 : 1e-3;
}

/// Of the whitened prediction, to which a `correction` of the base's coefficients belongs: seen
/// through the members as `passed` has it, it changes with those that pass it.
Eigen::MatrixXd derivatives(const Setting& setting, const Chain& chain,
                            const std::vector<Coordinate>& coordinates, const Eigen::VectorXd& here,
                            const Eigen::MatrixXd& passed, const Eigen::VectorXd& correction) {
  Eigen::MatrixXd columns(here.size(), static_cast<Index>(coordinates.size()));
  for_each_piece(columns.cols(), [&](Index k) {
    const Coordinate& c = coordinates[static_cast<std::size_t>(k)];
    const double step = difference_step(setting.study, chain.members(), c);
    Member moved = chain.members()[c.member];
    move(moved, c, step);
    Eigen::VectorXd there = setting.whitened(chain.with(moved, c.member));
    if (correction.size() > 0 && passes_base(moved)) {
      std::vector<Member> members = chain.members();
      members[c.member] = moved;
      there += (passed_base(setting, members) - passed) * correction;
    }
    columns.col(k) = (there - here) / step;
  });
  return columns;
}

/// The Gauss-Newton change of the coordinates. Amplitudes that it would make negative although they
/// may not be go to zero, and the others are solved for beside that; so does the height of a second
/// one above the first where it is EffectFit::rising.
Eigen::VectorXd best_change(const std::vector<Member>& members,
                            const std::vector<Coordinate>& coordinates, Eigen::MatrixXd tangent,
                            const Eigen::VectorXd& left, bool shapes_stay) {
  std::vector<Index> open(static_cast<std::size_t>(tangent.cols())), raised;
  std::iota(open.begin(), open.end(), 0);
  if (shapes_stay) {
    std::erase_if(open, [&](Index k) {
      const auto at = static_cast<std::size_t>(k);
      return at < coordinates.size() && coordinates[at].is_shape;
    });
  }
  // In place of a second amplitude its height above the first, which then raises both.
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const Coordinate& c = coordinates[k];
    if (c.is_shape || c.index != 1 || !members[c.member].form->rising) continue;
    const auto fs = static_cast<Index>(k);
    tangent.col(fs - 1) += tangent.col(fs);
    raised.push_back(fs);
  }
  const auto now = [&](std::size_t k) {
    const Eigen::VectorXd& amplitudes = members[coordinates[k].member].amplitudes;
    const bool rise = std::count(raised.begin(), raised.end(), static_cast<Index>(k)) > 0;
    return amplitudes(coordinates[k].index) - (rise ? amplitudes(0) : 0.0);
  };
  Eigen::VectorXd change = Eigen::VectorXd::Zero(tangent.cols());
  for (bool settled = false; !settled;) {
    Eigen::VectorXd rest = left;
    std::vector<bool> is_open(static_cast<std::size_t>(tangent.cols()), false);
    for (const Index k : open) is_open[static_cast<std::size_t>(k)] = true;
    for (Index k = 0; k < tangent.cols(); ++k) {
      if (!is_open[static_cast<std::size_t>(k)]) rest -= change(k) * tangent.col(k);
    }
    change(open) = least_squares(tangent(Eigen::all, open), rest);
    settled = true;
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      const Coordinate& c = coordinates[k];
      if (!is_open[k] || c.is_shape || !members[c.member].form->non_negative) continue;
      const auto at = static_cast<Index>(k);
      if (now(k) + change(at) >= 0.0) continue;
      change(at) = -now(k);
      open.erase(std::find(open.begin(), open.end(), at));
      settled = false;
    }
  }
  for (const Index fs : raised) change(fs) += change(fs - 1);
  return change;
}

/// What is always fitted, the base simulator as the members pass it, and how the cables among them
/// were bent when recordings began.
Eigen::MatrixXd with_beginnings(const Setting& setting, const std::vector<Member>& members) {
  Eigen::MatrixXd columns = setting.nuisance;
  const Eigen::MatrixXd base = passed_base(setting, members);
  columns.leftCols(base.cols()) = base;
  for (const Member& member : members) {
    const Eigen::MatrixXd begun = beginnings(setting, member, Detail::kFine);
    if (begun.cols() > 0) columns = appended(columns, begun);
  }
  return columns;
}

}  // namespace

Eigen::VectorXd Setting::whitened(const Signals& signals) const {
  return whitener(signals).cwiseProduct(mask);
}

bool has_own_offset(const Case& study, std::size_t log) {
  return study.logs[log].zeroed || (study.zeros_differ && log > 0 && !study.logs[0].zeroed);
}

Index Setting::flat_columns() const {
  Index own = 0;
  for (std::size_t k = 0; k < study.logs.size(); ++k) own += has_own_offset(study, k) ? 1 : 0;
  return static_cast<Index>(study.logs.front().regressors.size()) + own * study.channel_count();
}

std::vector<Signals> own_offsets(const Case& study) {
  std::vector<Signals> columns;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    for (Index j = 0; has_own_offset(study, k) && j < study.channel_count(); ++j) {
      Signals column;
      for (const Log& log : study.logs) {
        column.push_back(Eigen::MatrixXd::Zero(log.motion.samples(), study.channel_count()));
      }
      column[k].col(j).setOnes();
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

bool rests_at_bound(const Case& study, const Member& member) {
  constexpr double kRounding = 1e-9;
  const double most = most_of_second(study, member);
  return most < kInfinity && std::abs(member.amplitudes(1)) >= (1.0 - kRounding) * most;
}

JointFit joint_fit(const Setting& setting, std::vector<Member> members) {
  for (Member& m : members) {
    for (double& amplitude : m.amplitudes) amplitude = m.form->bounded(amplitude);
    hold_ratio(setting.study, m);
  }
  const Eigen::VectorXd wanted = setting.whitened(setting.measured);
  const auto coordinates = coordinates_of(members);
  Eigen::MatrixXd nuisance_columns = with_beginnings(setting, members);
  const Index free = static_cast<Index>(coordinates.size()), extra = nuisance_columns.cols();
  const auto linear = static_cast<Index>(setting.study.logs.front().regressors.size());
  const bool passing = linear > 0 && std::any_of(members.begin(), members.end(), passes_base);
  auto chain = std::make_unique<Chain>(setting.study, std::move(members));
  Eigen::VectorXd here = setting.whitened(chain->prediction());
  JointFit fit;
  fit.nuisance = least_squares(nuisance_columns, wanted - here);
  Eigen::VectorXd residual = wanted - here - nuisance_columns * fit.nuisance;
  fit.chi2 = residual.squaredNorm();
  fit.tangent.resize(here.size(), free + extra);
  bool shapes_stay = setting.study.without.refinement;
  for (int step = 0; step < kMostSteps; ++step) {
    if (passing) nuisance_columns.leftCols(linear) = passed_base(setting, chain->members());
    fit.tangent.rightCols(extra) = nuisance_columns;
    fit.tangent.leftCols(free) =
        derivatives(setting, *chain, coordinates, here, nuisance_columns.leftCols(linear),
                    fit.nuisance.head(linear));
    for (Index k = 0; k < free; ++k) {
      const Coordinate& c = coordinates[static_cast<std::size_t>(k)];
      if (!c.is_shape && chain->members()[c.member].is_held(c.index)) fit.tangent.col(k).setZero();
    }
    if (free == 0) break;
    // A number that the base simulator has too, as the rest of a spring beside a constant.
    const Eigen::MatrixXd base = orthonormal(nuisance_columns.leftCols(linear));
    const Eigen::MatrixXd off =
        base.cols() > 0 ? off_basis(fit.tangent.leftCols(free), base) : Eigen::MatrixXd();
    for (Index k = 0; k < off.cols(); ++k) {
      if (off.col(k).isZero(0.0)) fit.tangent.col(k).setZero();
    }
    const Eigen::VectorXd change =
        best_change(chain->members(), coordinates, fit.tangent, wanted - here, shapes_stay);
    if (!change.allFinite()) break;  // whitened by a floor next to nothing, columns overflow
    const double before = fit.chi2;
    bool better = false, straight = false;
    for (double length = 1.0; length > 0.02 && !better; length *= 0.4) {
      std::vector<Member> moved = chain->members();
      bool whole = length == 1.0;
      for (Index k = 0; k < free; ++k) {
        const Coordinate& c = coordinates[static_cast<std::size_t>(k)];
        const double most = longest_step(chain->members(), c);
        whole = whole && std::abs(change(k)) <= most;
        move(moved[c.member], c, length * std::clamp(change(k), -most, most));
      }
      for (Member& m : moved) hold_ratio(setting.study, m);
      if (passing) nuisance_columns.leftCols(linear) = passed_base(setting, moved);
      auto next = std::make_unique<Chain>(setting.study, std::move(moved));
      const Eigen::VectorXd there = setting.whitened(next->prediction());
      const Eigen::VectorXd nuisance = least_squares(nuisance_columns, wanted - there);
      const Eigen::VectorXd left = wanted - there - nuisance_columns * nuisance;
      const double chi2 = left.squaredNorm();
      if (!(chi2 < fit.chi2)) continue;
      better = true;
      // Where the prediction went along its tangent, that is the one here as well, and the next
      // step would be none.
      straight = whole && (wanted - here - fit.tangent * change - left).squaredNorm() < kStraight;
      chain = std::move(next);
      here = there;
      residual = left;
      fit.chi2 = chi2;
      fit.nuisance = nuisance;
    }
    // Far from the best amplitudes shapes may find no way down.
    if (!better && !shapes_stay) {
      shapes_stay = true;
      continue;
    }
    if (!better || straight || before - fit.chi2 < kSettled) break;
    shapes_stay = setting.study.without.refinement;
  }
  fit.members = chain->members();
  fit.residual = std::move(residual);
  if (linear > 0) fit.base = setting.study.base_coefficients + fit.nuisance.head(linear);
  if (const Index errors = setting.study.logs.front().base_errors.cols(); errors > 0) {
    // Where nothing is named yet, what is left is not the base's alone.
    fit.base = Eigen::VectorXd::Zero(errors);
    if (!fit.members.empty()) {
      fit.base = likeliest_errors(nuisance_columns, setting.flat_columns(), errors, wanted - here);
    }
  }
  return fit;
}

}  // namespace dcnn
