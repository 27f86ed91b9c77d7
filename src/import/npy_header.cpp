// SPDX-License-Identifier: Apache-2.0
#include "import/npy_header.h"

#include <charconv>

#include "data/text.h"
#include "import/bytes.h"

namespace dcnn {
namespace {

constexpr Index kMostElementsOfArray = Index{1} << 33;
constexpr std::size_t kMostFields = 1000;

/// Reads the one Python literal that NumPy writes.
class Literal {
 public:
  Literal(std::string_view text, const std::string& place) : text_(text), place_(place) {}

  bool next(char c) {
    blanks();
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void demand(char c) {
    if (!next(c)) broken();
  }
  std::string quoted() {
    demand('\'');
    const std::size_t end = text_.find('\'');
    if (end == std::string_view::npos) broken();
    const std::string out(text_.substr(0, end));
    text_.remove_prefix(end + 1);
    return out;
  }
  bool truth() {
    blanks();
    for (const std::string_view word : {"True", "False"}) {
      if (!text_.starts_with(word)) continue;
      text_.remove_prefix(word.size());
      return word == "True";
    }
    broken();
  }
  Index whole() {
    blanks();
    Index value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc() || value < 0) broken();
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }
  [[noreturn]] void broken() const {
    fail(Exit::kData, place_, ": the head of an array of NumPy is damaged at ", shown(text_));
  }

 private:
  void blanks() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n'))
      text_.remove_prefix(1);
  }

  std::string_view text_;
  const std::string& place_;
};

NpyField parse_descr(const std::string& descr, const Literal& literal) {
  if (descr == "|O") throw NotNumbers("has Python objects as elements, which only Python reads");
  if (descr.size() < 3) literal.broken();
  NpyField field;
  field.big = descr[0] == '>';
  field.kind = descr[1];
  const auto [end, error] =
      std::from_chars(descr.data() + 2, descr.data() + descr.size(), field.bytes);
  const bool whole = error == std::errc() && end == descr.data() + descr.size();
  const int b = field.bytes;
  const bool integer = field.kind == 'i' || field.kind == 'u';
  const bool known = (field.kind == 'f' && (b == 4 || b == 8)) || (field.kind == 'b' && b == 1) ||
                     (integer && (b == 1 || b == 2 || b == 4 || b == 8));
  if (!whole || !known) throw NotNumbers("has elements of type " + shown(descr));
  return field;
}

std::vector<NpyField> parse_fields(Literal* literal) {
  if (!literal->next('[')) return {parse_descr(literal->quoted(), *literal)};
  std::vector<NpyField> fields;
  while (!literal->next(']')) {
    if (fields.size() >= kMostFields) literal->broken();
    literal->demand('(');
    const std::string name = literal->quoted();
    literal->demand(',');
    fields.push_back(parse_descr(literal->quoted(), *literal));
    fields.back().name = name;
    if (literal->next(',')) throw NotNumbers("has fields that are arrays");
    literal->demand(')');
    literal->next(',');
  }
  return fields;
}

void parse_shape(Literal* literal, NpyHeader* header) {
  literal->demand('(');
  std::vector<Index> shape;
  while (!literal->next(')')) {
    if (shape.size() > 32) literal->broken();
    shape.push_back(literal->whole());
    literal->next(',');
  }
  while (shape.size() > 2 && shape.back() == 1) shape.pop_back();
  if (shape.size() == 3 && shape[1] == shape[2] && (shape[1] == 3 || shape[1] == 4)) {
    header->matrix = shape[1];
    shape = {shape[0], shape[1] * shape[1]};
  }
  if (shape.size() > 2) throw NotNumbers("has more than two dimensions");
  header->rows = shape.empty() ? 1 : shape[0];
  header->columns = shape.size() < 2 ? 1 : shape[1];
  if (header->rows == 0 || header->columns == 0) throw NotNumbers("is empty");
  if (header->rows > kMostElementsOfArray || header->columns > 100000 ||
      header->rows * std::max<Index>(1, header->columns) > kMostElementsOfArray) {
    literal->broken();
  }
}

template <class T>
double number_in(std::string_view data, std::uint64_t at, bool big, const std::string& place) {
  Bytes bytes(data.substr(static_cast<std::size_t>(at)), place);
  bytes.set_big_endian(big);
  return static_cast<double>(bytes.number<T>());
}

double element(const NpyField& field, std::string_view data, std::uint64_t at,
               const std::string& place) {
  const bool big = field.big;
  if (field.kind == 'f') {
    return field.bytes == 8 ? number_in<double>(data, at, big, place)
                            : number_in<float>(data, at, big, place);
  }
  const bool is_signed = field.kind == 'i';
  switch (field.bytes) {
    case 1:
      return is_signed ? number_in<std::int8_t>(data, at, big, place)
                       : number_in<std::uint8_t>(data, at, big, place);
    case 2:
      return is_signed ? number_in<std::int16_t>(data, at, big, place)
                       : number_in<std::uint16_t>(data, at, big, place);
    case 4:
      return is_signed ? number_in<std::int32_t>(data, at, big, place)
                       : number_in<std::uint32_t>(data, at, big, place);
    default:
      return is_signed ? number_in<std::int64_t>(data, at, big, place)
                       : number_in<std::uint64_t>(data, at, big, place);
  }
}

}  // namespace

std::uint64_t NpyHeader::row_bytes() const {
  std::uint64_t sum = 0;
  for (const NpyField& field : fields) sum += static_cast<std::uint64_t>(field.bytes);
  return sum;
}

std::uint64_t NpyHeader::bytes() const {
  return static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(columns) * row_bytes();
}

void NpyHeader::read_row(std::string_view data, Index row, const std::string& place,
                         std::vector<double>* out) const {
  std::uint64_t in_element = 0;
  for (const NpyField& field : fields) {
    for (Index column = 0; column < columns; ++column) {
      const Index at = fortran ? column * rows + row : row * columns + column;
      out->push_back(
          element(field, data, static_cast<std::uint64_t>(at) * row_bytes() + in_element, place));
    }
    in_element += static_cast<std::uint64_t>(field.bytes);
  }
}

NpyHeader parse_npy_header(std::string_view text, const std::string& place) {
  Literal literal(text, place);
  NpyHeader header;
  literal.demand('{');
  while (!literal.next('}')) {
    const std::string key = literal.quoted();
    literal.demand(':');
    if (key == "descr") {
      header.fields = parse_fields(&literal);
    } else if (key == "fortran_order") {
      header.fortran = literal.truth();
    } else if (key == "shape") {
      parse_shape(&literal, &header);
    } else {
      literal.broken();
    }
    literal.next(',');
  }
  if (header.fields.empty()) literal.broken();
  return header;
}

}  // namespace dcnn
