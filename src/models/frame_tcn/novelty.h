// Whether a motion lies in the band that training has seen.
#pragma once

#include "models/frame_tcn/blocks.h"

namespace dcnn::frame_tcn {

/// Of each channel and row: how strongly the means over 32 samples bend, their range, and the level.
struct Signs {
  Eigen::MatrixXd bend, range, level;  ///< (15, N)
  Signs(const Eigen::MatrixXd& x, const std::vector<Segment>& segments);
};

/// The largest bend of each channel depends on its noise: limits by bins of the level.
class Novelty {
 public:
  static constexpr Index kBins = 8;
  Eigen::MatrixXd limits;      ///< (15, kBins) of the bend
  Eigen::MatrixXd range;       ///< (15, kBins) of the range
  Eigen::MatrixXd level_span;  ///< (15, 2) least and largest level
  double calibration = 1.0;    ///< score of one row in 10^4

  Novelty();
  /// Widens the limits to what these rows show.
  void learn(const Signs& signs);
  /// After all rows are learned: spans of levels must have been set before (see learn_levels).
  void learn_levels(const Signs& signs);
  /// Bins that no row fell into take the limit of their neighbour.
  void finish();
  Eigen::VectorXd score(const Signs& signs) const;

 private:
  Index bin(Index channel, double level) const;
};

}  // namespace dcnn::frame_tcn
