// SPDX-License-Identifier: Apache-2.0
// Definitions of ROS messages: the text that bags carry.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

enum class FieldKind { kNumber, kString, kTime, kMessage };

struct MessageField {
  std::string name;
  FieldKind kind = FieldKind::kNumber;
  char number = 'd';  ///< b ? B h H i I q Q f d, as in Python's struct
  int bytes = 8;      ///< of a number; of a time 8
  int message = -1;   ///< index of its type
  bool array = false;
  Index length = -1;  ///< of a fixed array; -1: it stands in the data
};

struct MessageType {
  std::string name;  ///< "geometry_msgs/Wrench"
  std::vector<MessageField> fields;
};

/// types[0] is the message itself.
struct MessageSchema {
  std::vector<MessageType> types;
};

/// `name` is "pkg/Type" or "pkg/msg/Type". Error(kData), naming `place`, of what is not understood.
MessageSchema parse_message_schema(const std::string& name, std::string_view text, bool ros2,
                                   const std::string& place);

/// "pkg/Type".
std::string short_type(std::string_view name);

/// Definitions of the usual messages, for .db3 files, which carry none; empty where not known.
std::string_view standard_definition(const std::string& type);

}  // namespace dcnn
