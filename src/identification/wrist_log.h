// SPDX-License-Identifier: Apache-2.0
// Recordings of a wrist as the rows of a regression: low-passed to the motion's band and thinned.
#pragma once

#include <filesystem>
#include <vector>

#include "dcnn/data/recording.h"
#include "dcnn/physics/motion.h"

namespace dcnn::identification {

/// One recording, or one list of poses at rest. The motion is that of E: no mounting is applied.
struct WristLog {
  Recording recording;
  Motion motion;
  Eigen::VectorXd t;         ///< s, of every row; zero in a list without times
  Eigen::MatrixXd measured;  ///< (T, channels): fx, fy, fz, and tx, ty, tz where logged
  bool at_rest = false;      ///< poses at rest: rows are independent
  bool accelerated = true;   ///< the acceleration of the origin is known
  double cutoff_hz = 0.0;    ///< of the low-pass that both sides of the regression pass; 0: none
  double delay_s = 0.0;      ///< by which `measured` has been advanced
  std::vector<Index> kept;   ///< rows that are left after thinning
  std::vector<Segment> segments;  ///< of them

  /// (T, k) of the recording, low-passed and thinned to (kept, k).
  Eigen::MatrixXd thinned(const Eigen::MatrixXd& signals) const;
  /// Rows per second that are left; 0 at rest.
  double rate_hz() const;
};

/// Reads recordings. A list of poses, with times or without, is one at rest: without t, or with a
/// median step of `kRestStep` or more, in which no motion that matters could be told from the poses.
/// Torques are used where every recording has them. Faults are Error(kData).
std::vector<WristLog> read_wrist_logs(const std::vector<std::filesystem::path>& paths,
                                      const ReadOptions& options);

/// Whether a table lists poses at rest: as read_wrist_logs() says.
bool is_at_rest(const Table& table);
/// Takes the times of a list of poses out of its table: [s] from the first, zero without times.
Eigen::VectorXd take_times(Table& table);
/// Keeps every row of a list of poses, each a segment of its own.
void keep_all(WristLog& log);

/// Sets the rows that are left of a moving recording whose segments and cutoff are known.
void thin(WristLog& log);

/// The force read `seconds` later than the log has it: what a sensor that lags by so much measures.
void advance(WristLog& log, double seconds);

}  // namespace dcnn::identification
