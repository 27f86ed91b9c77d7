// SPDX-License-Identifier: Apache-2.0
// Effects of several numbers (a gain for each axis, a matrix of crosstalk) of which the recordings
// tell some alone: the others are held at zero. And levers that they do not tell.
#include <algorithm>
#include <cmath>

#include "core/tails.h"
#include "diagnosis/candidates.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/search.h"

namespace dcnn {
namespace {

constexpr double kHeldDeviations = prior::kSelection * kNormal95;

/// A fault of the sensor with several numbers: it can imitate a mass, a centre or a tilt.
bool is_sensor_fault(const Member& member) {
  return member.kind->stage == Stage::kSensor && has_entries(member);
}

/// One amplitude of one member, and its column of the tangent.
struct Entry {
  std::size_t member;
  Index amplitude, column;
};

/// A fit taken as linear about where it ended: min |target - T x|^2 with G = T'T, b = T' target.
struct LinearFit {
  Eigen::MatrixXd gram;
  Eigen::VectorXd match;

  explicit LinearFit(const JointFit& fit) {
    Eigen::VectorXd here = Eigen::VectorXd::Zero(fit.tangent.cols());
    for (std::size_t m = 0; m < fit.members.size(); ++m) {
      const auto [first, count] = tangent_columns(fit, m);
      if (count > 0)
        here.segment(first, fit.members[m].amplitudes.size()) = fit.members[m].amplitudes;
    }
    gram = fit.tangent.transpose() * fit.tangent;
    match = fit.tangent.transpose() * (fit.residual + fit.tangent * here);
  }
  /// Estimate and variance of the number of one column beside other columns.
  struct Number {
    double value, variance;
    /// What chi-square rises by where the number is held at zero.
    double worth() const { return variance > 0.0 ? value * value / variance : 0.0; }
  };
  std::vector<Number> numbers(const std::vector<Index>& open) const {
    const Eigen::MatrixXd inverse = normal_inverse(gram(open, open));
    const Eigen::VectorXd x = inverse * match(open);
    std::vector<Number> list;
    for (Index k = 0; k < x.size(); ++k) list.push_back({x(k), inverse(k, k)});
    return list;
  }
};

/// A fit with some entries held at zero.
struct Sparser {
  std::vector<Member> members;
  double cost = 0.0;  ///< what chi-square rises by, less the price of each number that is held
};

/// Holds every entry, the least telling first, that gains less than `price` beside the others.
class Holding {
 public:
  Holding(const JointFit& fit, double price) : fit_(fit), price_(price), linear_(fit) {
    for (Index k = 0; k < fit.tangent.cols(); ++k) {
      if (!fit.tangent.col(k).isZero(0.0)) measured_.push_back(k);
    }
    for (std::size_t m = 0; m < fit.members.size(); ++m) {
      const Index first = tangent_columns(fit, m).first;
      if (!has_entries(fit.members[m])) continue;
      for (Index i = 0; i < fit.members[m].amplitudes.size(); ++i) {
        const bool told =
            std::find(measured_.begin(), measured_.end(), first + i) != measured_.end();
        if (told) entries_.push_back({m, i, first + i});
      }
    }
  }
  Sparser sparser() const { return held_after({}); }
  /// Beside one more number, of which a sensor's fault may be an alias: whichever of the fault's
  /// entries goes first, the others tell how they differ from it.
  Sparser sparsest() const {
    Sparser best = sparser();
    for (const Entry& e : entries_) {
      if (!is_sensor_fault(fit_.members[e.member])) continue;
      Sparser other = held_after({e});
      if (other.cost < best.cost) best = std::move(other);
    }
    return best;
  }

 private:
  Sparser held_after(std::vector<Entry> held) const {
    std::vector<Entry> entries = entries_;
    std::vector<Index> open = measured_;
    Sparser result{fit_.members};
    const auto worth = [&](const Entry& e) {
      const auto at = std::find(open.begin(), open.end(), e.column) - open.begin();
      return linear_.numbers(open)[static_cast<std::size_t>(at)].worth();
    };
    const auto hold = [&](const Entry& e, double rise) {
      result.cost += rise - price_;
      std::erase(open, e.column);
      std::erase_if(entries, [&](const Entry& other) { return other.column == e.column; });
    };
    for (const Entry& e : held) hold(e, worth(e));
    while (!entries.empty()) {
      const auto numbers = linear_.numbers(open);
      const Entry* least = nullptr;
      double rise = price_;
      for (const Entry& e : entries) {
        const auto at = std::find(open.begin(), open.end(), e.column) - open.begin();
        const double own = numbers[static_cast<std::size_t>(at)].worth();
        if (own < rise) rise = own, least = &e;
      }
      if (!least) break;
      const Entry e = *least;
      held.push_back(e);
      hold(e, rise);
    }
    for (const Entry& e : held) mark(e, open, result.members[e.member]);
    std::erase_if(result.members, [](const Member& m) {
      return !m.held.empty() && m.amplitudes.isZero(0.0) && m.shapes.size() == 0;
    });
    return result;
  }

  /// Holds an entry of a member, with the interval in which the numbers in `open` leave it.
  void mark(const Entry& e, std::vector<Index> open, Member& member) const {
    open.push_back(e.column);
    const auto number = linear_.numbers(open).back();
    const double reach = kHeldDeviations * std::sqrt(std::max(0.0, number.variance));
    member.amplitudes(e.amplitude) = 0.0;
    member.held.push_back(
        {e.amplitude, std::min(0.0, number.value - reach), std::max(0.0, number.value + reach)});
  }

  const JointFit& fit_;
  double price_;
  LinearFit linear_;
  std::vector<Index> measured_;
  std::vector<Entry> entries_;
};

double priced(const JointFit& fit, double price) {
  int numbers = 0;
  for (const Member& member : fit.members) numbers += member.parameters();
  return fit.chi2 + price * numbers;
}

}  // namespace

/// Holds at zero what the recordings do not tell of effects with several numbers, and prefers the
/// simulator's own numbers where with one of them a sensor's fault needs fewer: a common part of a
/// gain is a mass. A number counts that gains its price.
void Search::hold_untold() {
  if (study_.axis) return;
  const double price = setting_->price * rest_loudness();
  JointFit fitted = joint_fit(*setting_, Holding(fit_, price).sparser().members);
  bool changed = priced(fitted, price) < priced(fit_, price);
  if (!changed) fitted = fit_;
  const bool faulty = std::any_of(fitted.members.begin(), fitted.members.end(), is_sensor_fault);
  for (const Member& own : own_parameters(study_)) {
    const auto is_own = [&](const Member& m) { return m.kind == own.kind; };
    const bool there = std::any_of(fit_.members.begin(), fit_.members.end(), is_own);
    const bool refuted = std::any_of(refuted_.begin(), refuted_.end(), is_own);
    if (!faulty || there || refuted || !is_listed(study_, *own.kind)) continue;
    std::vector<Member> members = fit_.members;
    for (Member& m : members) m.held.clear();
    members.push_back(own);
    const JointFit beside = joint_fit(*setting_, members);
    const JointFit other = joint_fit(*setting_, Holding(beside, price).sparsest().members);
    if (priced(other, price) >= priced(fitted, price) - prior::kLeastExchange * price) continue;
    fitted = other;
    changed = true;
  }
  if (!changed) return;
  const bool same_names = fitted.members.size() == fit_.members.size();
  settle(std::vector<Member>(fitted.members));
  bands_ = band_tests(*setting_, fit_.residual);
  if (!same_names) weigh_once();
}

/// Begins with the simulator's own numbers, without those that are not told, where they alone are
/// likelier than all names that were found one by one: of several numbers that are wrong together
/// none need stand out, and a law that makes nearly the same forces is found first.
bool Search::begin_with_own_numbers() {
  if (study_.axis) return false;
  std::vector<Member> members = apart_;
  for (Member& own : own_parameters(study_)) {
    if (is_listed(study_, *own.kind)) members.push_back(std::move(own));
  }
  const double price = setting_->price;
  const JointFit all = joint_fit(*setting_, std::move(members));
  const JointFit told = joint_fit(*setting_, Holding(all, price).sparser().members);
  if (priced(told, price) >= priced(fit_, price) - prior::kLeastExchange * price) return false;
  say("beginning again with the simulator's own numbers");
  settle(std::vector<Member>(told.members));
  return true;
}

void Search::leave_bounded_lags() {
  std::vector<Member> members = fit_.members;
  bool some = false;
  for (Member& member : members) {
    if (!member.driver || !is_at_bound(member, member.own_shapes() - 1)) continue;
    leave_out_lag(member);
    some = true;
  }
  if (some) settle(members);
}

void Search::leave_untold_parts() {
  leave_bounded_lags();
  const double price = setting_->price * rest_loudness();
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    if (!fit_.members[m].driver) continue;
    std::vector<Member> members = fit_.members;
    leave_out_lag(members[m]);
    const JointFit at_once = joint_fit(*setting_, members);
    if (at_once.chi2 - fit_.chi2 < price) settle(at_once.members);
  }
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    const auto levers = static_cast<double>(fit_.members[m].levers());
    if (levers == 0.0) continue;
    std::vector<Member> members = fit_.members;
    leave_out_lever(members[m]);
    const JointFit at_origin = joint_fit(*setting_, members);
    if (at_origin.chi2 - fit_.chi2 < price * levers) settle(at_origin.members);
  }
}

}  // namespace dcnn
