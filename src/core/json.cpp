// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/json.h"

#include <algorithm>

#include "dcnn/core/excerpt.h"

namespace dcnn {
namespace {

[[noreturn]] void wrong(const char* wanted, const Json& value) {
  throw Json::exception(std::string("not ") + wanted + ": " + excerpt(value.dump()));
}

}  // namespace

Json::Json() = default;
Json::Json(const Json& other) = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(const Json& other) = default;
Json& Json::operator=(Json&& other) noexcept = default;
Json::~Json() = default;

Json::Json(std::nullptr_t) {}
Json::Json(std::string text) : value_(std::move(text)) {}
Json::Json(std::string_view text) : value_(std::string(text)) {}
Json::Json(const char* text) : value_(std::string(text)) {}

Json::Json(std::initializer_list<Item> items) : Json(array(items)) {
  const std::vector<Json>& list = array_items();
  const bool members = std::all_of(list.begin(), list.end(), [](const Json& item) {
    return item.is_array() && item.size() == 2 && item[0].is_string();
  });
  if (!members) return;
  Json all = object();
  for (const Json& item : list) all.member(item[0].get<std::string>()) = item[1];
  *this = std::move(all);
}

Json Json::array() {
  Json out;
  out.value_ = std::vector<Json>();
  return out;
}

Json Json::array(std::initializer_list<Item> items) {
  Json out = array();
  for (const Item& item : items) out.push_back(item.value());
  return out;
}

Json Json::object() {
  Json out;
  out.value_ = std::vector<Member>();
  return out;
}

std::size_t Json::size() const {
  if (is_null()) return 0;
  if (const auto* list = std::get_if<std::vector<Json>>(&value_)) return list->size();
  if (const auto* members = std::get_if<std::vector<Member>>(&value_)) return members->size();
  return 1;
}

const Json* Json::find(std::string_view key) const {
  const auto* members = std::get_if<std::vector<Member>>(&value_);
  if (!members) return nullptr;
  for (const Member& member : *members) {
    if (member.first == key) return &member.second;
  }
  return nullptr;
}

const Json* Json::object_member(std::string_view key) const {
  if (!is_object()) wrong("an object", *this);
  return find(key);
}

const Json& Json::at(std::string_view key) const {
  const Json* found = object_member(key);
  if (!found) throw exception("key '" + excerpt(key) + "' not found");
  return *found;
}

Json& Json::at(std::string_view key) { return const_cast<Json&>(std::as_const(*this).at(key)); }

const Json& Json::at(std::size_t index) const {
  const auto& items = array_items();
  if (index >= items.size()) {
    throw exception("index " + std::to_string(index) + " of a list of " +
                    std::to_string(items.size()));
  }
  return items[index];
}

Json& Json::at(std::size_t index) { return const_cast<Json&>(std::as_const(*this).at(index)); }

Json& Json::member(std::string_view key) {
  if (is_null()) value_ = std::vector<Member>();
  if (const Json* found = object_member(key)) return const_cast<Json&>(*found);
  return std::get<std::vector<Member>>(value_).emplace_back(key, Json()).second;
}

Json& Json::element(std::size_t index) {
  if (is_null()) value_ = std::vector<Json>();
  if (!is_array()) wrong("a list", *this);
  auto& list = std::get<std::vector<Json>>(value_);
  if (index >= list.size()) list.resize(index + 1);
  return list[index];
}

void Json::push_back(Json value) {
  if (is_null()) value_ = std::vector<Json>();
  if (!is_array()) wrong("a list", *this);
  std::get<std::vector<Json>>(value_).push_back(std::move(value));
}

void Json::update(const Json& members) {
  if (is_null()) value_ = std::vector<Member>();
  for (const auto& [key, value] : members.object_items()) member(key) = value;
}

void Json::erase(std::string_view key) {
  if (!is_object()) wrong("an object", *this);
  std::erase_if(std::get<std::vector<Member>>(value_),
                [key](const Member& member) { return member.first == key; });
}

void Json::erase(std::size_t index) {
  at(index);
  auto& list = std::get<std::vector<Json>>(value_);
  list.erase(list.begin() + static_cast<std::ptrdiff_t>(index));
}

const std::vector<Json>& Json::array_items() const {
  const auto* list = std::get_if<std::vector<Json>>(&value_);
  if (!list) wrong("a list", *this);
  return *list;
}

template <class Pair, class Self>
Json::Walk<Self, Pair> Json::place(Self& self, std::size_t index) {
  if (auto* members = std::get_if<std::vector<Member>>(&self.value_)) {
    return {nullptr, members->data() + index};
  }
  if (auto* list = std::get_if<std::vector<Json>>(&self.value_)) {
    return {list->data() + index, nullptr};
  }
  return {&self + index, nullptr};
}

Json::Walk<Json, Json::Member> Json::begin() { return place<Member>(*this, 0); }
Json::Walk<Json, Json::Member> Json::end() { return place<Member>(*this, size()); }
Json::Walk<const Json, const Json::Member> Json::begin() const {
  return place<const Member>(*this, 0);
}
Json::Walk<const Json, const Json::Member> Json::end() const {
  return place<const Member>(*this, size());
}

const std::vector<Json::Member>& Json::object_items() const {
  const auto* members = std::get_if<std::vector<Member>>(&value_);
  if (!members) wrong("an object", *this);
  return *members;
}

const std::vector<Json::Member>& Json::items() const {
  static const std::vector<Member> none;
  return is_null() ? none : object_items();
}

std::vector<Json::Member>& Json::items() {
  return const_cast<std::vector<Member>&>(std::as_const(*this).items());
}

double Json::real() const {
  if (const auto* real = std::get_if<double>(&value_)) return *real;
  if (const auto* natural = std::get_if<std::uint64_t>(&value_))
    return static_cast<double>(*natural);
  if (const auto* whole = std::get_if<std::int64_t>(&value_)) return static_cast<double>(*whole);
  if (const auto* truth = std::get_if<bool>(&value_)) return *truth ? 1.0 : 0.0;
  wrong("a number", *this);
}

std::int64_t Json::whole() const {
  if (const auto* natural = std::get_if<std::uint64_t>(&value_))
    return static_cast<std::int64_t>(*natural);
  if (const auto* whole = std::get_if<std::int64_t>(&value_)) return *whole;
  constexpr double kBeyond = 9223372036854775808.0;  // 2^63
  const double number = real();
  if (!(number >= -kBeyond && number < kBeyond)) wrong("a whole number", *this);
  return static_cast<std::int64_t>(number);
}

void Json::read(bool& out) const {
  if (!is_boolean()) wrong("true or false", *this);
  out = std::get<bool>(value_);
}

void Json::read(std::string& out) const {
  if (!is_string()) wrong("a string", *this);
  out = std::get<std::string>(value_);
}

bool Json::equal(const Json& a, const Json& b) {
  if (!a.is_number() || !b.is_number()) return a.value_ == b.value_;
  // 1, 1u and 1.0 are one number.
  if (a.is_number_integer() && b.is_number_integer()) {
    return a.whole() == b.whole() && (a.whole() >= 0 || a.value_.index() == b.value_.index());
  }
  return a.real() == b.real();
}

}  // namespace dcnn
