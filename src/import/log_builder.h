// SPDX-License-Identifier: Apache-2.0
// Collects rows of streams while a log is read.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "dcnn/import/log.h"

namespace dcnn {

class LogBuilder {
 public:
  LogBuilder(ForeignLog& log, const ReadLogOptions& options) : log_(log), options_(options) {}

  /// The stream of `key`, made from `make` where it is new. The Error(kData) of more streams or
  /// channels than a log of numbers has.
  template <class Make>
  std::size_t stream(const std::string& key, const Make& make) {
    const auto found = streams_.find(key);
    return found != streams_.end() ? found->second : add_stream(key, make());
  }

  /// What is read from now on is of this file, the `number`-th of the log (from 1).
  void begin_file(const std::string& stem, std::size_t number) {
    stem_ = stem;
    number_ = number;
  }
  /// What the names of streams that are alike in each file begin with: "file2/", nothing in the
  /// first.
  std::string file_prefix() const {
    return number_ > 1 ? "file" + std::to_string(number_) + "/" : "";
  }

  /// The next `count` of the names that are given for the columns of all texts of the log.
  std::vector<std::string> next_columns(std::size_t count);
  std::size_t columns_taken() const { return taken_; }

  /// Times in s; NaN where the log has none of that kind.
  void add(std::size_t stream, double stamped, double received, std::span<const double> row);

  ForeignLog& log() { return log_; }
  const ReadLogOptions& options() const { return options_; }

 private:
  std::size_t add_stream(const std::string& key, LogStream stream);

  ForeignLog& log_;
  const ReadLogOptions& options_;
  std::map<std::string, std::size_t> streams_;
  std::vector<std::vector<char>> keep_;
  std::string stem_;
  std::size_t number_ = 1, taken_ = 0;
};

}  // namespace dcnn
