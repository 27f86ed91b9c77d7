// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/holdout.h"

#include <algorithm>
#include <cmath>

#include "core/tails.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/rest.h"

namespace dcnn {
namespace {

constexpr double kPiece = 5.0, kShortPiece = 1.0;  // s: of which every kEvery-th is held out
constexpr double kGuard = 0.1;                     // on either side, of a piece
constexpr int kEvery = 5, kFewestPieces = 4;       // held out, where they are no shorter than 1 s
constexpr double kSameError = 1e-9;                // rounding, of noise that the error bounds
constexpr Index kLeastPoses = 10;  // 8 remain to fit to, as many as their floor needs

double seconds_of(const Motion& motion) { return motion.t(motion.samples() - 1) - motion.t(0); }

/// Every kEvery-th pose of a list.
void hold_out_poses(std::size_t log, const Eigen::VectorXd& t, std::vector<Span>& spans) {
  if (t.size() < kLeastPoses) return;
  for (Index i = kEvery / 2; i < t.size(); i += kEvery) {
    const double next = i + 1 < t.size() ? t(i + 1) : t(i) + 1.0;
    spans.push_back({log, 0.5 * (t(i - 1) + t(i)), 0.5 * (t(i) + next)});
  }
}

/// One piece of 5 s is one place of a motion that comes by once: short recordings have shorter
/// ones.
double piece_of(const Case& study) {
  double all = 0.0;
  for (const Log& log : study.logs) all += log.motion.is_static() ? 0.0 : seconds_of(log.motion);
  return std::clamp(all / (kEvery * kFewestPieces), kShortPiece, kPiece);
}

/// A recording that no whole piece fits into is cut into kEvery pieces.
double shortened(double piece, const Motion& motion) {
  const double length = seconds_of(motion);
  return length >= (kEvery - 2) * piece ? piece : length / kEvery;
}

}  // namespace

std::vector<Span> held_out_blocks(const Case& study, bool with_guards) {
  std::vector<Span> spans;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Motion& motion = study.logs[k].motion;
    if (motion.is_static()) {
      hold_out_poses(k, motion.t, spans);
      continue;
    }
    const double first = motion.t(0), last = motion.t(motion.samples() - 1);
    const double piece = shortened(piece_of(study), motion);
    const double guard = with_guards ? kGuard * piece : 0.0;
    // No more blocks than rows: where a gap is longer than a period, the next row decides.
    const double period = kEvery * piece, start = first + (kEvery - 3) * piece;
    for (Index row = 0; row < motion.samples();) {
      const double t = start + period * std::floor((motion.t(row) - first) / period);
      if (t + piece > last + 1e-9) break;
      spans.push_back({k, t - guard, t + piece + guard});
      do {
        ++row;
      } while (row < motion.samples() && motion.t(row) < t + 3.0 * piece);
    }
  }
  return spans;
}

HoldOut::HoldOut(const Case& fitted, const Case& recordings) {
  const bool own = !recordings.logs.empty();
  blocks_ = !own;
  study_ = own ? recordings : fitted;
  if (own && !study_.is_static()) set_derivative(study_, fitted.derivative);
  const auto blocks = held_out_blocks(study_, false), resting = rests(study_);
  for (std::size_t k = 0; k < study_.logs.size(); ++k) {
    const Motion& motion = study_.logs[k].motion;
    std::vector<char> held(static_cast<std::size_t>(motion.samples()), 0);
    for (const Segment& s : inner_segments(study_, k)) {
      for (Index i = s.begin; i < s.end; ++i) {
        const double t = motion.t(i);
        const auto holds = [&](const Span& span) { return span.holds(k, t) && t < span.end; };
        held[static_cast<std::size_t>(i)] = own || std::any_of(blocks.begin(), blocks.end(), holds);
      }
    }
    for (const Span& span : resting) {
      if (span.log != k) continue;
      const auto [from, to] = rows_of(motion, span);
      std::fill(held.begin() + from, held.begin() + to, 0);
    }
    held_.push_back(held);
  }
}

bool HoldOut::empty() const {
  return std::all_of(held_.begin(), held_.end(), [](const std::vector<char>& rows) {
    return std::find(rows.begin(), rows.end(), 1) == rows.end();
  });
}

Signals HoldOut::prediction(const std::vector<Member>& members, const Eigen::VectorXd& base) const {
  Case study = study_;
  if (base.size() > 0) set_base(study, base);
  Signals predicted = predict(study, members);
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    if (study_.logs[k].zeroed) add_own_offset(k, predicted[k]);
  }
  return predicted;
}

void HoldOut::add_own_offset(std::size_t k, Eigen::MatrixXd& predicted) const {
  const Eigen::MatrixXd left = study_.logs[k].measured - predicted;
  Eigen::RowVectorXd inside = Eigen::RowVectorXd::Zero(left.cols()), outside = inside;
  double held = 0.0;
  for (Index i = 0; i < left.rows(); ++i) {
    const bool is_held = held_[k][static_cast<std::size_t>(i)] != 0;
    (is_held ? inside : outside) += left.row(i);
    held += is_held ? 1.0 : 0.0;
  }
  const double others = static_cast<double>(left.rows()) - held;
  predicted.rowwise() += blocks_ ? Eigen::RowVectorXd(outside / std::max(1.0, others))
                                 : Eigen::RowVectorXd(inside / std::max(1.0, held));
}

HoldOut HoldOut::unfiltered() const {
  HoldOut raw = *this;
  raw.study_.lowpass_hz = 0.0;
  for (Log& log : raw.study_.logs) {
    if (log.unfiltered.rows() > 0) log.measured = log.unfiltered;
  }
  return raw;
}

std::vector<double> HoldOut::rmse(const std::vector<Member>& members,
                                  const Eigen::VectorXd& base) const {
  const Signals predicted = prediction(members, base);
  std::vector<double> result;
  for (Index j = 0; j < study_.channel_count(); ++j) {
    double square = 0.0, count = 0.0;
    for (std::size_t k = 0; k < predicted.size(); ++k) {
      for (Index i = 0; i < predicted[k].rows(); ++i) {
        if (!held_[k][static_cast<std::size_t>(i)]) continue;
        const double error = predicted[k](i, j) - study_.logs[k].measured(i, j);
        square += error * error;
        count += 1.0;
      }
    }
    result.push_back(count > 0.0 ? std::sqrt(square / count) : 0.0);
  }
  return result;
}

HoldOut::Worth HoldOut::worth(const std::vector<Member>& members,
                              const Eigen::VectorXd& base) const {
  const Signals predicted = prediction(members, base);
  const Index channels = study_.channel_count();
  Eigen::ArrayXd measured = Eigen::ArrayXd::Zero(channels), error = measured;
  double rows = 0.0;
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    std::vector<Index> held;
    for (Index i = 0; i < predicted[k].rows(); ++i) {
      if (held_[k][static_cast<std::size_t>(i)]) held.push_back(i);
    }
    if (held.empty()) continue;
    const auto variation = [&](const Eigen::MatrixXd& x) -> Eigen::ArrayXd {
      return (x.rowwise() - x.colwise().mean()).colwise().squaredNorm().transpose();
    };
    const Eigen::MatrixXd y = study_.logs[k].measured(held, Eigen::all);
    measured += variation(y);
    error += variation(y - predicted[k](held, Eigen::all));
    rows += static_cast<double>(held.size());
  }
  Worth worth;
  for (Index j = 0; j < channels; ++j) {
    worth.measured_rms.push_back(std::sqrt(measured(j) / std::max(1.0, rows)));
    worth.explained.push_back(measured(j) > 0.0 ? 1.0 - error(j) / measured(j) : 0.0);
  }
  return worth;
}

double HoldOut::mean_rmse(const std::vector<Member>& members, const Eigen::VectorXd& base) const {
  double sum = 0.0;
  for (const double error : rmse(members, base)) sum += error;
  return sum / static_cast<double>(study_.channel_count());
}

double HoldOut::left_where_fitted(const Search& search, Index channel) const {
  const Case& fitted = search.study();
  double square = 0.0, rows = 0.0;
  for (std::size_t k = 0; k < fitted.logs.size(); ++k) {
    for (const Segment& s : inner_segments(fitted, k)) {
      for (Index i = s.begin; i < s.end; ++i) {
        if (blocks_ && held_[k][static_cast<std::size_t>(i)]) continue;
        const double left = search.left()[k](i, channel);
        square += left * left;
        rows += 1.0;
      }
    }
  }
  return std::sqrt(square / std::max(1.0, rows));
}

std::optional<HoldOut::Excess> HoldOut::excess(const Search& search,
                                               const std::vector<Floor>& floors) const {
  const std::vector<double> errors = rmse(search.fit().members, search.fit().base);
  double rows = 0.0;
  for (const auto& held : held_)
    rows += static_cast<double>(std::count(held.begin(), held.end(), 1));
  // Relative deviation of an rms of n normal numbers: 1/sqrt(2n).
  const auto block = static_cast<double>(search.setting().whitener.block());
  const double independent = kNormal95 / std::sqrt(2.0 * std::max(1.0, rows / block));
  const Case& fitted = search.study();
  std::vector<double> inexact(errors.size(), 0.0);  // a machine's simulator, as any law
  if (fitted.axis) inexact = worth(search.fit().members, search.fit().base).measured_rms;
  for (double& error : inexact) error *= prior::kModelError;
  double fitted_rows = 0.0;
  for (const Log& log : fitted.logs) fitted_rows += static_cast<double>(log.motion.samples());
  // What the band above the motion hardly tells of the noise below may all be left of the fit.
  // Slow noise is none of recordings without one whole period of it.
  const double periods = search.bands().empty() ? 0.0 : search.bands().front().dof;
  std::optional<std::vector<Floor>> all;
  if (!fitted.is_static() && periods >= 3.0 * static_cast<double>(fitted.channel_count())) {
    const Signals left = unfiltered_left(fitted, search.fit().members);
    all = noise_of_all(fitted, left, noise_level(fitted, left), search.floors());
  }
  std::optional<Excess> worst;
  for (std::size_t j = 0; j < errors.size(); ++j) {
    const double fitted_noise = search.floors()[j].whole_deviation();
    const double left = left_where_fitted(search, static_cast<Index>(j));
    // Of recordings of their own the noise is as loud as they say; of held-out blocks as it is
    // beside them, for it is bounded by the error that is judged.
    double noise = blocks_ ? fitted_noise : floors[j].whole_deviation();
    const double stated = noise;
    if (all) {
      const double most = std::min((*all)[j].deviation(), left);
      noise = std::max(noise, most * std::min(1.0, noise / fitted_noise));
    }
    // Of an axis the error of the motion has a spectrum of its own in the floor. Poses are few: a
    // free matrix may leave less of them than noise, and what the fit leaves was weighed. What no
    // band was tested for, because the recordings are too short, may be anything, and so may what
    // names leave: that they explain all is said at their own noise.
    const bool tested = std::any_of(search.bands().begin(), search.bands().end(),
                                    [](const BandTest& band) { return band.dof > 0.0; });
    const bool left_is_noise =
        fitted.is_static() || (tested && !fitted.axis && search.fit().members.empty() &&
                               !search.floors()[j].pose_gain.empty());
    if (left_is_noise) noise = std::max(noise, left);
    noise = std::sqrt(noise * noise + inexact[j] * inexact[j]);
    double chance = independent;
    if (!fitted.is_static()) {  // the noise of either recording is a sample of it
      const Floor& floor = search.floors()[j];
      const double held = floor.power_deviation(rows * fitted.dt()),
                   known = floor.power_deviation(fitted_rows * fitted.dt());
      chance = std::max(chance, 0.5 * kNormal95 * std::sqrt(held * held + known * known));
    }
    const double ratio = errors[j] / std::max(1e-300, noise);
    if (ratio > prior::kMostOverNoise * (1.0 + chance) && (!worst || ratio > worst->ratio)) {
      worst = Excess{j, ratio, noise > prior::kMostOverNoise * stated};
    }
  }
  return worst;
}

bool HoldOut::is_noise(const Search& search, const std::vector<Floor>& floors, double most) const {
  if (empty()) return false;
  const std::vector<double> errors = rmse(search.fit().members, search.fit().base);
  for (std::size_t j = 0; j < errors.size(); ++j) {
    if (errors[j] > most * (1.0 + kSameError) * floors[j].deviation()) return false;
  }
  return true;
}

double HoldOut::support_of_impacts(const Search& search) const {
  if (blocks_) return 0.0;
  const JointFit& fit = search.fit();
  Signals left = prediction(fit.members, fit.base);
  for (std::size_t k = 0; k < left.size(); ++k) left[k] = study_.logs[k].measured - left[k];
  return impacts_support(study_, left, search.impacts());
}

std::vector<HeldOut> HoldOut::records(const JointFit& first, const JointFit& last) const {
  const Signals before = prediction(first.members, first.base),
                after = prediction(last.members, last.base);
  std::vector<HeldOut> records;
  for (std::size_t k = 0; k < after.size(); ++k) {
    const Log& log = study_.logs[k];
    records.push_back(
        {log.recording.name, log.motion.t, log.measured, before[k], after[k], held_[k]});
  }
  return records;
}

}  // namespace dcnn
