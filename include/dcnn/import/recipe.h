// SPDX-License-Identifier: Apache-2.0
// What of a log becomes which column of a recording: import.json.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"
#include "dcnn/import/log.h"

namespace dcnn {

/// One channel: (unwrap(raw, wrap) - offset)·gain in `unit`, then SI.
struct ColumnRule {
  std::string to = {};      ///< column of the recording, or a working name (recipe.cpp)
  std::string stream = {};  ///< empty: the log's only stream
  std::string channel = {};
  std::string unit = {};  ///< empty: SI
  std::string why = {};   ///< how the unit is known
  bool assumed = false;   ///< told by the size of the values alone
  double wrap = 0.0;      ///< counts after which a register begins anew; 0: it does not
  double offset = 0.0, gain = 1.0;
};

/// Where the times of a stream come from.
struct ClockRule {
  std::string stream;
  std::string kind = "none";  ///< "header", "receive", "column", "rate", "none" (static poses)
  std::string channel, nanoseconds;  ///< of kind column; the second one beside whole seconds
  std::string unit = "s", why;
  bool assumed = false;
  double hz = 0.0;      ///< of kind rate
  double offset = 0.0;  ///< s, added: this clock's error against the first stream's
};

struct OrientationRule {
  std::string kind;           ///< "", "euler", "quaternion", "matrix", "rotation-vector", "joints"
  std::string order = "ZYX";  ///< of euler: capitals about moving axes, small letters about fixed
  bool inverse = false;       ///< the log has the pose of the base in the tool
};

struct WrenchRule {
  std::string frame = "sensor";                      ///< "base": turned into the sensor's frame
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();    ///< rx,ry,rz of the logged frame in E, rad
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the logged frame in E, m
  bool zeroed = false;  ///< the sensor was set to zero for each recording
  Payload payload;      ///< whose weight the controller has subtracted; it is added back
};

struct ArmRule {
  std::string urdf, base, link;
};

struct Recipe {
  int files = 1;  ///< that make one recording
  TextDialect text;
  std::string clock;  ///< the stream whose rows are the recording's
  std::vector<ClockRule> clocks;
  std::vector<ColumnRule> columns;
  OrientationRule orientation;
  WrenchRule wrench;
  ArmRule arm;
  double resample_hz = 0.0;  ///< 0: rows as logged

  /// Nothing but what the recipe names is kept while a log is read.
  bool names(const LogStream& stream, const std::string& channel) const;
};

Json to_json(const Recipe& recipe);
Recipe parse_recipe(const Json& json, const std::string& where);
Recipe read_recipe(const std::filesystem::path& path);

/// What the user says about a log; all else is found from it.
struct ImportWishes {
  std::vector<std::string> use;                   ///< streams, where several would do
  std::map<std::string, std::string> map, units;  ///< by column of the recording
  std::map<std::string, double> gains, offsets, wraps;
  std::map<std::string, double> clock_offsets;  ///< by stream, s
  std::vector<std::string> clock;               ///< channels, one for each stream that needs one
  std::string clock_unit, stamps = "header";
  double rate_hz = 0.0;
  std::string quaternion_order, euler_order;
  std::vector<std::string> also;  ///< channels to keep under their names
  OrientationRule orientation;
  WrenchRule wrench;  ///< its frame "auto": as the robot's maker says, else the sensor's
  ArmRule arm;
};

struct Proposal {
  Recipe recipe;
  std::vector<std::string> questions;  ///< what must be said first, each with its option
  std::vector<std::string> guesses;    ///< units told by size alone, each with the option to say so
  std::vector<std::string> notes;
};

/// Which channels of messages may become columns: all others keep only their figures.
std::function<bool(const LogStream&, const std::string& channel)> worth_keeping(
    const ImportWishes& wishes);

/// Finds by names, types and sizes what a log's channels are.
Proposal propose(const ForeignLog& log, const ImportWishes& wishes);

}  // namespace dcnn
