// SPDX-License-Identifier: Apache-2.0
// Lines of a text file in blocks of fixed size: a recording of any length needs the memory of one
// line.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

class LineReader {
 public:
  /// Anything but a readable regular file is an Error(kData).
  explicit LineReader(const std::filesystem::path& path);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// The next line without its end ("\n" or "\r\n"); valid until the next call. False at the end.
  bool next(std::string_view* line);

  /// Number of the line last given, from 1.
  Index number() const { return number_; }
  /// "file:line".
  std::string place() const { return place(number_); }
  std::string place(Index number) const { return name_ + ":" + std::to_string(number); }
  const std::string& name() const { return name_; }

 private:
  bool take(std::size_t length, std::string_view* line);
  void refill();
  std::size_t read(char* to) const;

  std::string name_;
  int fd_ = -1;           // none: standard input
  std::size_t read_ = 0;  // bytes
  bool ended_ = false;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // of the unread bytes in buffer_
  Index number_ = 0;
};

}  // namespace dcnn
