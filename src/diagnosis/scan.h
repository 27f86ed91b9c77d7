// SPDX-License-Identifier: Apache-2.0
// What one more effect would gain, everything already in the model refitted beside it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/joint_fit.h"

namespace dcnn {

struct Trial {
  Member member;
  double gain = 0.0;  ///< of chi-square; 0 where a sign refutes the effect
  double kept = 1.0;  ///< share of its columns' energy that the model at hand cannot imitate
  Eigen::VectorXd deviation;    ///< of each amplitude, from the noise alone
  double price = kNumberPrice;  ///< Setting::price

  /// Less the price of each fitted number (an exact law explains far more, a coincidence less).
  double net_gain() const { return gain - price * member.parameters(); }
};

/// The gain from which on an effect with so many numbers, next to no other or to some, is more than
/// noise makes of it.
double least_gain(const Setting& setting, int numbers, bool alone);

/// At which samples a candidate's columns are computed: all, or as many as a search needs.
enum class Detail { kFine, kCoarse };

class Scan {
 public:
  Scan(const Setting& setting, const JointFit& fit);

  /// Best amplitudes of the member at its shapes, linear in the prediction of the model at hand.
  Trial evaluate(const Member& member, Detail detail = Detail::kFine) const;
  /// A first, short search for better shapes, at samples for a search; over a comb of frequencies
  /// where a seed may be far from the best.
  Trial approach(const Trial& seed) const;
  /// Shapes improved from where they are (Nelder and Mead 1965 on their search scales).
  Trial refine(const Trial& start, Detail detail = Detail::kFine, int evaluations = 40) const;
  /// The best mode on the axis of this one that a short search meets; no gain where there is none.
  Trial best_mode(const Member& mode) const;
  /// Modes of its axis, among those that a search meets, whose gain is at most `within` below the
  /// largest.
  std::vector<Member> as_likely(const Member& mode, double within) const;
  /// Its whitened columns, (rows, amplitudes), or one column for an effect without amplitudes.
  Eigen::MatrixXd columns(const Member& member, Detail detail = Detail::kFine) const;
  /// The least rms, in the unit of the channel it shows on most, at which the effect would be named
  /// with a probability of 90 %; none where the model at hand can imitate it entirely.
  std::optional<double> least_detectable(const Member& member) const;
  /// Whether its amplitudes and shapes are those of such an effect.
  bool is_possible(const Member& member) const;
  Eigen::MatrixXd off_model(const Eigen::MatrixXd& columns) const;
  const Eigen::VectorXd& residual() const { return residual_; }
  const Setting& setting() const { return setting_; }
  const Chain& chain() const { return chain_; }
  /// Of the model at hand, at the samples of a search.
  const Signals& coarse_prediction() const { return coarse_chain_.prediction(); }

 private:
  /// Whitened prediction with the member besides, less that without it.
  Eigen::VectorXd added(const Member& member, Detail detail) const;
  /// Fits the lever at which the trial's force acts beside its amplitudes, to which `columns`
  /// belong; all off the model at hand and off `beside`.
  void fit_lever(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& beside, Detail detail,
                 Trial& trial) const;
  Trial combed(const Trial& start) const;
  Trial lagged(const Trial& start) const;
  Trial tuned(const Trial& start, Detail detail) const;
  std::vector<Trial> local_minima(const Member& mode, Detail detail, std::size_t most) const;
  Trial improved(const Trial& start, Detail detail, int evaluations,
                 std::vector<Trial>* seen = nullptr) const;

  const Setting& setting_;
  Chain chain_;
  Chain coarse_chain_;
  Eigen::VectorXd here_, coarse_here_;  // whitened predictions
  Eigen::MatrixXd tangent_;
  Index first_of_base_ = 0;  // of its columns
  Eigen::MatrixXd basis_;
  Eigen::VectorXd residual_;  // off the basis
  std::vector<Index> force_rows_;
};

/// Minimises f from x with steps of the given size; returns the best point.
Eigen::VectorXd simplex_search(const std::function<double(const Eigen::VectorXd&)>& f,
                               const Eigen::VectorXd& x, const Eigen::VectorXd& size,
                               int evaluations);

}  // namespace dcnn
