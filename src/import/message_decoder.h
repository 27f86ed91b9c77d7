// SPDX-License-Identifier: Apache-2.0
// Numbers of ROS messages by their definitions: CDR (ROS 2) and the serialisation of ROS 1.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/bytes.h"
#include "import/log_builder.h"
#include "import/message_layout.h"
#include "import/message_schema.h"

namespace dcnn {

/// A topic: adds a row per message (per element of a list of stamped ones, as in tf) to a log.
/// Messages of one topic whose arrays have other lengths, or whose frames or joints have other
/// names, are streams of their own.
class MessageDecoder {
 public:
  MessageDecoder(std::string topic, MessageSchema schema, bool cdr)
      : topic_(std::move(topic)), schema_(std::move(schema)), cdr_(cdr), list_(is_list()) {}

  /// `received`: s.
  void decode(std::string_view message, double received, const std::string& place,
              LogBuilder& builder);

 private:
  struct Sample {
    std::vector<double> values;
    std::vector<std::string> names;  ///< of the values, where they are asked for
    std::string shape;               ///< lengths and names that make a stream of its own
    std::string frame, child;
    double stamp;
  };

  void start(Bytes* bytes);
  void read_message(const MessageType& type, const std::string& path, Bytes* bytes, bool keep);
  void read_field(const MessageField& field, const std::string& path, Bytes* bytes, bool keep,
                  std::vector<std::string>* labels);
  void read_header(const MessageType& type, Bytes* bytes);
  void read_element(const MessageField& field, const std::string& path, Bytes* bytes, bool keep);
  double read_number(const MessageField& field, Bytes* bytes) const;
  double read_time(const MessageField& field, Bytes* bytes) const;
  /// `tells`: its content makes a stream of its own.
  std::string_view read_string(Bytes* bytes, bool tells);
  void align(std::size_t size, Bytes* bytes) const;
  void skip_numbers(const MessageField& field, std::uint64_t count, Bytes* bytes) const;
  void value(double number, const std::string& path);
  std::uint64_t read_count(Bytes* bytes);
  void read_sample(const MessageType& type, Bytes* bytes);
  /// The number of the stream it was added to; none where there are too many.
  std::optional<std::size_t> add_sample(const MessageType& type, const Bytes& before,
                                        double received, LogBuilder& builder);
  bool decode_by_layout(std::string_view message, double received, LogBuilder& builder);
  LogStream describe(const MessageType& type) const;
  bool is_list() const;

  std::string topic_;
  MessageSchema schema_;
  bool cdr_, list_;
  bool named_ = false;       ///< whether paths are made
  int depth_ = 0;            ///< of the message that is being read
  std::size_t aligned_ = 8;  ///< largest alignment
  Sample sample_;
  std::vector<MessageLayout> layouts_;  ///< of messages that were read field by field
  MessageLayout layout_;                ///< of the one that is being read
  std::map<std::string, std::size_t> streams_;
};

}  // namespace dcnn
