// SPDX-License-Identifier: Apache-2.0
// Where the numbers of a message lie: found once, and valid for every message with the same lengths
// and names in it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dcnn {

class MessageLayout {
 public:
  /// What decides where everything else lies: lengths, counts, names of joints and frames.
  void fix(std::size_t at, std::size_t length) { fixed_.push_back({at, length}); }
  /// `number`: as MessageField::number; 't' for a time, 'T' for one with signed seconds.
  void add_value(std::size_t at, char number) { values_.push_back({at, number}); }
  void set_stamp(std::size_t at, char number) { stamp_ = {at, number}, has_stamp_ = true; }
  /// Of the message that was walked through; `stream` is the number of its stream.
  void finish(std::string_view message, bool big_endian, std::size_t stream);

  std::size_t parts() const { return fixed_.size(); }
  bool fits(std::string_view message) const;
  /// Numbers of a message that fits.
  void read(std::string_view message, std::vector<double>* values) const;
  double stamp(std::string_view message) const;
  bool has_stamp() const { return has_stamp_; }
  std::size_t stream() const { return stream_; }

 private:
  struct Range {
    std::size_t at, length;
  };
  struct Place {
    std::size_t at;
    char number;
  };
  double number(std::string_view message, const Place& place) const;

  std::vector<Range> fixed_;
  std::vector<Place> values_;
  Place stamp_{0, 't'};
  bool has_stamp_ = false, swap_ = false;
  std::string decisive_;  // the bytes of the ranges, one after the other
  std::size_t size_ = 0, stream_ = 0;
};

}  // namespace dcnn
