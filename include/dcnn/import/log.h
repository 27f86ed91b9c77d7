// SPDX-License-Identifier: Apache-2.0
// What a log of somebody else holds: streams of named channels, each stream with clocks of its own.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// How many values are how large: the largest of each power of two.
class SizeCount {
 public:
  void add(double value);
  /// The largest size, but for the hundredth of the values that is largest: rows may be broken.
  double usual() const;

 private:
  static constexpr int kLeast = -64, kMost = 63;  ///< powers of two that are told apart
  std::array<double, kMost - kLeast + 1> largest_{};
  std::array<Index, kMost - kLeast + 1> count_{};
  Index all_ = 0;
};

/// One number per row: a column of a text, a numeric field of a message.
struct LogChannel {
  std::string name;            ///< "Fx", "wrench.force.x", "position[elbow]"
  std::string unit;            ///< as the source states it, empty where it does not
  std::vector<double> values;  ///< NaN: missing; empty where only the figures below are kept
  Index finite = 0;            ///< values that are numbers
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool whole = true;  ///< all of them whole numbers
  SizeCount sizes;
  double largest_step = 0.0;  ///< between neighbours
  double last = std::numeric_limits<double>::quiet_NaN();

  void add(double value, bool keep);
};

/// Channels that are sampled together: a text file, a topic, arrays of one length.
struct LogStream {
  std::string name;    ///< the topic or variable; the file's stem for a text
  std::string type;    ///< "geometry_msgs/WrenchStamped", "text", "array"
  std::string frame;   ///< header.frame_id
  std::string child;   ///< child_frame_id
  std::string source;  ///< the file's stem, of texts and arrays
  bool si = false;     ///< the type's definition says SI units (ROS, REP 103)
  std::vector<LogChannel> channels;
  std::vector<double> stamped;   ///< s, the sender's stamp in the message
  std::vector<double> received;  ///< s, when the recorder wrote it
  Index rows = 0;

  /// Its index, -1 where there is none.
  Index find(const std::string& channel) const;
};

struct ForeignLog {
  std::string file;    ///< as in messages
  std::string format;  ///< "text, separated by ';', decimal comma"
  std::vector<LogStream> streams;
  std::vector<std::string> notes;  ///< what was left out or changed, for the user
  std::string command;             ///< ReadLogOptions::command
};

/// How a text is written; what is not given is found from the text itself.
struct TextDialect {
  std::string separator;             ///< "," ";" "|" "tab" "space"
  std::string decimal;               ///< "." ","
  std::vector<std::string> columns;  ///< names of a text without a header
};

struct ReadLogOptions {
  TextDialect text;
  /// Whether the values of a channel are kept, else only their figures: what is not named by a
  /// recipe costs no memory. Empty: all are kept.
  std::function<bool(const LogStream&, const std::string& channel)> wanted;
  bool accept_truncated = false;  ///< take what is whole of a log that ends in the middle
  std::string
      command;  ///< command line that reads the log, for proposals; empty: of its name alone
};

/// Reads any known format, by its content; several files are one log (a split bag, one file per
/// channel). Memory: one chunk of the file and the channels that are kept. Anything broken is an
/// Error(kData).
ForeignLog read_log(const std::vector<std::filesystem::path>& paths, const ReadLogOptions& options);

/// The words for --help: formats that this build can read, and what is missing.
std::string known_formats();

}  // namespace dcnn
