// SPDX-License-Identifier: Apache-2.0
// Coordinates and directions of a problem's recordings, and the whitened columns of laws.
#pragma once

#include "dcnn/discovery/discover.h"
#include "discovery/sketch.h"

namespace dcnn::discovery {

using Eigen::Index;

class Data {
 public:
  explicit Data(const Problem& problem);

  const Problem& problem() const { return problem_; }
  Index samples() const { return samples_; }
  double seconds() const { return seconds_; }
  double dt() const { return dt_; }
  /// Whether the recordings are of a machine's axis.
  bool of_axis() const { return of_axis_; }
  /// Logged columns that laws may take.
  const std::vector<std::string>& signals() const { return signals_; }

  /// Whether the recordings hold the coordinate and it changes. Of coordinates along a law's own
  /// direction: ranges of any direction.
  bool varies(std::size_t coordinate) const { return high_[coordinate] > low_[coordinate]; }
  const Eigen::VectorXd& coordinate(std::size_t coordinate) const { return values_[coordinate]; }
  double low(std::size_t coordinate) const { return low_[coordinate]; }
  double high(std::size_t coordinate) const { return high_[coordinate]; }
  double middle(std::size_t c) const { return 0.5 * (low_[c] + high_[c]); }
  double half_range(std::size_t c) const { return 0.5 * (high_[c] - low_[c]); }
  double rms(std::size_t c) const { return rms_[c]; }
  /// Of the box of places that were reached, m.
  double diagonal() const { return path_range_.back(); }
  /// The path that the coordinate makes, or its integral where it is a rate, from end to end.
  double path_range(std::size_t c) const { return path_range_[c]; }

  /// Root of the mean square of its length.
  double size_of(std::size_t direction) const { return sizes_[direction]; }
  bool has_direction(std::size_t direction) const { return sizes_[direction] > 0.0; }

  /// The product of factors, without direction and lag, (T); coordinates of a law's own direction
  /// are those of `of`.
  Eigen::VectorXd product(const std::vector<Piece>& pieces, const Sketch& of) const;
  /// The same behind a lag, or behind many.
  Eigen::VectorXd lagged(const Eigen::VectorXd& signal, double tau, double spread = 0.0) const;
  /// The direction of a sketch over its scale and behind its lag, (T,3).
  Eigen::MatrixXd vector_of(const Sketch& sketch) const;
  /// The whitened column of a sketch of unit amplitude beside what is known, rows that must not be
  /// looked at zero.
  Eigen::VectorXd column(const Sketch& sketch) const;
  /// The same, not projected.
  Eigen::VectorXd raw_column(const Sketch& sketch) const;
  /// The same of a product of factors and a direction that are known, behind the lag of `sketch`.
  Eigen::VectorXd raw_column(Eigen::VectorXd product, const Eigen::MatrixXd& vector,
                             const Sketch& sketch) const;
  /// Beside what is known: of a column, or of many at once, which is faster.
  Eigen::MatrixXd projected(const Eigen::MatrixXd& columns) const;
  /// Whitens a force (T,3).
  Eigen::VectorXd whiten(const Eigen::MatrixXd& force) const;
  /// The transpose of that, (T,3).
  Eigen::MatrixXd transposed(const Eigen::VectorXd& rows) const;

 private:
  void read(const Record& record, Index begin);
  void measure();
  /// Ranges of coordinates along any direction, and of the distance from any point around.
  void measure_own();
  Eigen::MatrixXd presliding(double length) const;
  /// (T,3), all recordings below each other, in the direction's own unit.
  Eigen::MatrixXd direction(const Sketch& sketch) const;
  Eigen::VectorXd own_coordinate(std::size_t coordinate, const Sketch& of) const;

  const Problem& problem_;
  Index samples_ = 0;
  double seconds_ = 0.0, dt_ = 0.0;
  bool of_axis_ = false;
  std::vector<std::string> signals_;
  std::vector<Index> begins_;  // first sample of each record, and the end of the last
  Eigen::VectorXd step_;       // s since the sample before; of the first of a record, dt
  std::vector<law::Sample> now_;
  std::vector<Eigen::VectorXd> values_;
  std::vector<double> low_, high_, rms_, path_range_, sizes_;
  std::vector<Eigen::MatrixXd> directions_;
};

}  // namespace dcnn::discovery
