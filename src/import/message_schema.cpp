// SPDX-License-Identifier: Apache-2.0
#include "import/message_schema.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>
#include <sstream>

#include "data/text.h"
#include "dcnn/core/error.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostDefinition = std::size_t{1} << 20;
constexpr std::size_t kDeepest = 32;

struct Primitive {
  const char* name;
  char code;
  int bytes;
};

constexpr std::array<Primitive, 14> kPrimitives = {{{"bool", '?', 1},
                                                    {"byte", 'b', 1},
                                                    {"char", 'B', 1},
                                                    {"int8", 'b', 1},
                                                    {"uint8", 'B', 1},
                                                    {"int16", 'h', 2},
                                                    {"uint16", 'H', 2},
                                                    {"int32", 'i', 4},
                                                    {"uint32", 'I', 4},
                                                    {"int64", 'q', 8},
                                                    {"uint64", 'Q', 8},
                                                    {"float32", 'f', 4},
                                                    {"float64", 'd', 8},
                                                    {"float", 'f', 4}}};

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) {
    text.remove_suffix(1);
  }
  return text;
}

/// One line of a definition, before types are looked up.
struct RawField {
  std::string type, name;
  bool array = false;
  Index length = -1;
};

class SchemaParser {
 public:
  SchemaParser(const std::string& name, bool ros2, const std::string& place)
      : root_(short_type(name)), ros2_(ros2), place_(place) {}

  MessageSchema parse(std::string_view text) {
    require(text.size() <= kMostDefinition, Exit::kData, place_, ": the definition of ",
            shown(root_), " has ", text.size(), " bytes");
    collect(text);
    add_type(root_);
    return std::move(schema_);
  }

 private:
  /// Sections, each after a line of '=' and "MSG: pkg/Type".
  void collect(std::string_view text) {
    std::string current = root_;
    raw_[current] = {};
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      line = without_blanks(line.substr(0, line.find('#')));
      if (line.empty() || line.find_first_not_of('=') == std::string_view::npos) continue;
      if (line.substr(0, 4) == "MSG:") {
        current = short_type(without_blanks(line.substr(4)));
        raw_[current] = {};
      } else {
        read_field(line, &raw_[current]);
      }
    }
  }

  void read_field(std::string_view line, std::vector<RawField>* fields) const {
    const std::size_t blank = std::min(line.find_first_of(" \t"), line.size());
    std::string_view type = line.substr(0, blank);
    const std::string_view rest = without_blanks(line.substr(blank));
    const std::size_t end = std::min(rest.find_first_of(" \t="), rest.size());
    RawField field;
    field.name = rest.substr(0, end);
    require(!field.name.empty(), Exit::kData, place_, ": the definition of ", shown(root_),
            " has a line that is no field: ", shown(line));
    const std::string_view value = without_blanks(rest.substr(end));
    if (!value.empty() && value.front() == '=') return;  // a constant
    if (const std::size_t open = type.find('['); open != std::string_view::npos) {
      read_length(type.substr(open), &field);
      type = type.substr(0, open);
    }
    field.type = type.substr(0, type.find("<="));  // bounded strings
    fields->push_back(std::move(field));
  }

  void read_length(std::string_view brackets, RawField* field) const {
    field->array = true;
    require(brackets.size() >= 2 && brackets.back() == ']', Exit::kData, place_,
            ": the definition of ", shown(root_), " has an array ", shown(brackets));
    const std::string_view inside = brackets.substr(1, brackets.size() - 2);
    if (inside.empty() || inside.substr(0, 2) == "<=") return;
    const auto [end, error] =
        std::from_chars(inside.data(), inside.data() + inside.size(), field->length);
    require(error == std::errc() && end == inside.data() + inside.size() && field->length >= 0 &&
                field->length <= (Index{1} << 24),
            Exit::kData, place_, ": the definition of ", shown(root_), " has an array of length ",
            shown(inside));
  }

  /// "Point" in "geometry_msgs/Pose" is "geometry_msgs/Point".
  std::string resolve(const std::string& type, const std::string& inside) const {
    if (type == "Header") return "std_msgs/Header";
    if (type.find('/') != std::string::npos) return short_type(type);
    return inside.substr(0, inside.find('/') + 1) + type;
  }

  bool set_primitive(const std::string& type, MessageField* field) const {
    for (const Primitive& primitive : kPrimitives) {
      if (type != primitive.name) continue;
      field->number = primitive.code;
      field->bytes = primitive.bytes;
      if (type == "byte" && ros2_) field->number = 'B';
      return true;
    }
    if (type == "double") return true;
    if (type == "string") {
      field->kind = FieldKind::kString;
      return true;
    }
    if (type != "time" && type != "duration") return false;
    field->kind = FieldKind::kTime;
    field->number = type == "duration" ? 'i' : 'I';
    return true;
  }

  int add_type(const std::string& type) {
    if (const auto known = index_.find(type); known != index_.end()) {
      require(!open_.contains(type), Exit::kData, place_, ": the type ", shown(type),
              " contains itself");
      return known->second;
    }
    const auto raw = raw_.find(type);
    std::vector<RawField> fields;
    if (raw != raw_.end()) {
      fields = raw->second;
    } else {
      const std::string_view standard = standard_definition(type);
      require(!standard.empty(), Exit::kData, place_, ": holds no definition of the type ",
              shown(type), " that ", shown(root_), " contains");
      std::istringstream lines{std::string(standard)};
      for (std::string line; std::getline(lines, line);) read_field(line, &fields);
    }
    require(open_.size() < kDeepest, Exit::kData, place_, ": the type ", shown(root_),
            " is nested too deeply");
    const int index = index_[type] = static_cast<int>(schema_.types.size());
    open_.insert(type);
    schema_.types.push_back({type, {}});
    std::vector<MessageField> made;
    for (const RawField& field : fields) made.push_back(make_field(field, type));
    schema_.types[static_cast<std::size_t>(index)].fields = std::move(made);
    open_.erase(type);
    return index;
  }

  MessageField make_field(const RawField& raw, const std::string& inside) {
    MessageField field;
    field.name = raw.name;
    field.array = raw.array;
    field.length = raw.length;
    if (set_primitive(raw.type, &field)) return field;
    const std::string type = resolve(raw.type, inside);
    if (type == "builtin_interfaces/Time" || type == "builtin_interfaces/Duration") {
      field.kind = FieldKind::kTime;
      field.number = 'i';
      return field;
    }
    field.kind = FieldKind::kMessage;
    field.message = add_type(type);
    return field;
  }

  std::string root_;
  bool ros2_;
  const std::string& place_;
  std::map<std::string, std::vector<RawField>> raw_;
  std::map<std::string, int> index_;
  std::set<std::string> open_;
  MessageSchema schema_;
};

}  // namespace

MessageSchema parse_message_schema(const std::string& name, std::string_view text, bool ros2,
                                   const std::string& place) {
  return SchemaParser(name, ros2, place).parse(text);
}

std::string short_type(std::string_view name) {
  const std::size_t first = name.find('/'), last = name.rfind('/');
  if (first == last) return std::string(name);
  return std::string(name.substr(0, first)) + std::string(name.substr(last));
}

}  // namespace dcnn
