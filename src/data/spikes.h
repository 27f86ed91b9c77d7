// SPDX-License-Identifier: Apache-2.0
// Single rows far off their neighbours: a bit that flipped, a reading that was lost.
#pragma once

#include <string>
#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn {

/// The rows of a column that noise is least likely to have made: so many, so far out.
struct Spikes {
  std::vector<Index> rows;  ///< ascending
  double height = 0.0;      ///< of the farthest, in deviations of a row from its neighbours
  /// Probability that noise with the tails of Student's t of five degrees of freedom makes as many.
  double p = 1.0;

  /// "3 outliers in fx, up to 12 standard deviations from their neighbours"
  std::string words(const std::string& column) const;
};

/// Two-sided tail of Student's t with five degrees of freedom far out, at z deviations: noise of
/// sensors at its worst.
double heavy_tail(double z);

/// The farthest of some rows that stand out.
struct Outliers {
  std::size_t count = 0;
  double p = 1.0;  ///< that noise makes so many so far out
};
/// The number of rows that such noise is least likely to make among `rows`; heights in deviations,
/// falling. As many numbers are tried as there are heights, so p is Bonferroni's.
Outliers least_likely_outliers(const std::vector<double>& heights, Index rows);

/// Deviation, by their median, of distances that are not zero: a channel at its limit repeats one
/// value. Where most rows lie on lines between others, as those that were filled in, of the rest. 0
/// where all are zero.
double deviation_of_moving(const Eigen::VectorXd& distances);

/// Of values (T) in the order of time. A row is single where its two neighbours on either side lie
/// within 0.3 of its distance from them, which an impact of several rows does not leave so.
Spikes spikes_of(const Eigen::VectorXd& values);

/// Puts the middle of the neighbours in the place of spikes that noise makes with a probability
/// below 0.001, in these columns of a recording with a clock, and notes so. More than three, and
/// than a row in a thousand, are left: heavy-tailed noise, or the impacts of a loose load.
void mend_spikes(Recording& recording, const std::vector<std::string>& columns);

}  // namespace dcnn
