// SPDX-License-Identifier: Apache-2.0
#include "import/message_layout.h"

#include <bit>
#include <cstring>

namespace dcnn {
namespace {

template <class T>
T load(const char* from, bool swap) {
  std::uint8_t raw[sizeof(T)];
  std::memcpy(raw, from, sizeof(T));
  if (swap) {
    for (std::size_t k = 0; k < sizeof(T) / 2; ++k) std::swap(raw[k], raw[sizeof(T) - 1 - k]);
  }
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

}  // namespace

void MessageLayout::finish(std::string_view message, bool big_endian, std::size_t stream) {
  // Neighbouring ranges are compared at once.
  std::vector<Range> merged;
  for (const Range& range : fixed_) {
    if (!merged.empty() && merged.back().at + merged.back().length == range.at) {
      merged.back().length += range.length;
    } else {
      merged.push_back(range);
    }
  }
  fixed_ = std::move(merged);
  for (const Range& range : fixed_) decisive_ += message.substr(range.at, range.length);
  size_ = message.size();
  stream_ = stream;
  swap_ = big_endian != (std::endian::native == std::endian::big);
}

bool MessageLayout::fits(std::string_view message) const {
  if (message.size() != size_) return false;
  const char* decisive = decisive_.data();
  for (const Range& range : fixed_) {
    if (std::memcmp(message.data() + range.at, decisive, range.length) != 0) return false;
    decisive += range.length;
  }
  return true;
}

double MessageLayout::number(std::string_view message, const Place& place) const {
  const char* from = message.data() + place.at;
  switch (place.number) {
    case 'b':
      return load<std::int8_t>(from, swap_);
    case '?':
    case 'B':
      return load<std::uint8_t>(from, swap_);
    case 'h':
      return load<std::int16_t>(from, swap_);
    case 'H':
      return load<std::uint16_t>(from, swap_);
    case 'i':
      return load<std::int32_t>(from, swap_);
    case 'I':
      return load<std::uint32_t>(from, swap_);
    case 'q':
      return static_cast<double>(load<std::int64_t>(from, swap_));
    case 'Q':
      return static_cast<double>(load<std::uint64_t>(from, swap_));
    case 'f':
      return static_cast<double>(load<float>(from, swap_));
    case 't':
      return load<std::uint32_t>(from, swap_) + 1e-9 * load<std::uint32_t>(from + 4, swap_);
    case 'T':
      return load<std::int32_t>(from, swap_) + 1e-9 * load<std::uint32_t>(from + 4, swap_);
    default:
      return load<double>(from, swap_);
  }
}

void MessageLayout::read(std::string_view message, std::vector<double>* values) const {
  values->clear();
  for (const Place& place : values_) values->push_back(number(message, place));
}

double MessageLayout::stamp(std::string_view message) const { return number(message, stamp_); }

}  // namespace dcnn
