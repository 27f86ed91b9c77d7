// SPDX-License-Identifier: Apache-2.0
// Protocol Buffers' wire format, as much of it as an ONNX file needs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace dcnn::onnx {

/// A message being written: fields by number, in the order of the calls.
class Message {
 public:
  Message& number(int field, std::int64_t value) {
    key(field, 0);
    varint(static_cast<std::uint64_t>(value));
    return *this;
  }
  /// Text, raw bytes or a message that is finished.
  Message& bytes(int field, std::string_view value) {
    key(field, 2);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  Message& message(int field, const Message& value) { return bytes(field, value.bytes_); }
  /// The fields of another one.
  Message& append(const Message& other) {
    bytes_ += other.bytes_;
    return *this;
  }
  const std::string& str() const { return bytes_; }

 private:
  void key(int field, std::uint64_t type) { varint(static_cast<std::uint64_t>(field) << 3 | type); }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

}  // namespace dcnn::onnx
