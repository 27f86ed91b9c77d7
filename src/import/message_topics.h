// SPDX-License-Identifier: Apache-2.0
// Topics of a bag: decoders by connection, and what cannot be decoded.
#pragma once

#include <map>
#include <set>

#include "import/message_decoder.h"

namespace dcnn {

class MessageTopics {
 public:
  MessageTopics(LogBuilder& builder, std::string place)
      : builder_(builder), place_(std::move(place)) {}

  bool known(std::uint32_t id) const { return decoders_.contains(id) || left_out_.contains(id); }
  /// `encoding`: "cdr" or "ros1". What is of another encoding, or has no definition, is left out
  /// and said.
  void add(std::uint32_t id, const std::string& topic, const std::string& type,
           const std::string& encoding, std::string_view definition);
  /// `received`: s.
  void message(std::uint32_t id, double received, std::string_view bytes);
  void finish();

 private:
  LogBuilder& builder_;
  std::string place_;
  std::map<std::uint32_t, MessageDecoder> decoders_;
  std::set<std::uint32_t> left_out_;
  std::set<std::string> words_;
};

}  // namespace dcnn
