// SPDX-License-Identifier: Apache-2.0
#include "import/message_topics.h"

#include "data/text.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostTopics = 65536;

}  // namespace

void MessageTopics::add(std::uint32_t id, const std::string& topic, const std::string& type,
                        const std::string& encoding, std::string_view definition) {
  if (known(id)) return;
  require(decoders_.size() + left_out_.size() < kMostTopics, Exit::kData, place_, ": more than ",
          kMostTopics, " topics");
  const bool cdr = encoding == "cdr";
  if (!cdr && encoding != "ros1") {
    left_out_.insert(id);
    words_.insert(shown(topic) + " is encoded as " + shown(encoding) + ": left out");
    return;
  }
  if (definition.empty()) definition = standard_definition(short_type(type));
  if (definition.empty()) {
    left_out_.insert(id);
    words_.insert(shown(topic) + " is of type " + shown(type) +
                  ", whose definition the log does not hold: left out");
    return;
  }
  try {
    decoders_.emplace(
        id, MessageDecoder(topic, parse_message_schema(type, definition, cdr, place_), cdr));
  } catch (const Error& error) {
    left_out_.insert(id);
    words_.insert(shown(topic) + " is left out: " + error.what());
  }
}

void MessageTopics::message(std::uint32_t id, double received, std::string_view bytes) {
  if (left_out_.contains(id)) return;
  const auto found = decoders_.find(id);
  require(found != decoders_.end(), Exit::kData, place_, ": a message is of connection ", id,
          ", which the log does not define");
  found->second.decode(bytes, received, place_, builder_);
}

void MessageTopics::finish() {
  for (const std::string& words : words_) builder_.log().notes.push_back(words);
  words_.clear();
}

}  // namespace dcnn
