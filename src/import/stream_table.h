// SPDX-License-Identifier: Apache-2.0
// The columns that one stream gives to a recording, in SI, on its own clock.
#pragma once

#include <string>
#include <vector>

#include "dcnn/import/recipe.h"

namespace dcnn {

struct StreamTable {
  std::string stream;
  std::vector<double> t;  ///< s, increasing; empty for static poses
  std::vector<std::string> columns;
  Eigen::MatrixXd values;

  Index find(const std::string& column) const;
  bool has(const std::string& column) const { return find(column) >= 0; }
  void drop(const std::vector<std::string>& names);
  void set(const std::string& column, const Eigen::VectorXd& values);
  /// Columns of zeros for those of these names that are not there yet.
  void add(const std::vector<std::string>& names);
};

/// The rows in which every used channel is a number, in the order of their times. Messages that
/// share a stamp keep the first; a text whose clock stands still or goes back is an Error(kData).
/// One table; of a file that writes the rows of several sensors below each other, each in columns
/// of its own, one for each of them.
std::vector<StreamTable> make_stream_tables(const ForeignLog& log, const Recipe& recipe,
                                            const ClockRule& clock,
                                            std::vector<std::string>* notes);

/// Matrix, rotation vector, angles in another order, joint angles: all become qw,qx,qy,qz (angles
/// about z, y', x'' stay as they are). Quaternions are normalised and their signs made continuous.
void convert_orientation(const Recipe& recipe, StreamTable* table, const std::string& file);

/// All streams on the rows of the first: poses and rates by cubic spline, all else linearly; rows
/// outside of a stream, or inside of one of its gaps, are left out.
StreamTable join_streams(std::vector<StreamTable> tables, std::vector<std::string>* notes);

/// Force and torque into the sensor's frame and origin.
void turn_wrench(const WrenchRule& rule, StreamTable* table, const std::string& file);

}  // namespace dcnn
