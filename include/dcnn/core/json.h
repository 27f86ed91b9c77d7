// SPDX-License-Identifier: Apache-2.0
// JSON as this project reads and writes it: keys keep their order, input is parsed strictly.
// A value type of a few members stands in front of nlohmann-json, which parses and prints in one
// file: named in every file it was a seventh of the time to compile the library.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <iosfwd>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "dcnn/core/error.h"

namespace dcnn {

class Json;

namespace json_detail {

template <class T>
struct IsReadable : std::bool_constant<std::is_arithmetic_v<T> && !std::is_same_v<T, char>> {};
template <>
struct IsReadable<std::string> : std::true_type {};
template <class T>
struct IsReadable<std::vector<T>>
    : std::bool_constant<IsReadable<T>::value || std::is_same_v<T, Json>> {};
template <class T>
struct IsReadable<std::map<std::string, T>> : IsReadable<T> {};

}  // namespace json_detail

/// A type that get() and an assignment can make of a JSON value.
template <class T>
concept JsonReadable = json_detail::IsReadable<T>::value;

/// null, a truth value, a number, a string, a list or an object whose keys keep their order.
/// What a value is not (a number of a string, a key that is absent) is an exception; user input is
/// checked through Options, which turns it into a line for the user.
class Json {
 public:
  using Member = std::pair<std::string, Json>;
  class Item;

  struct exception : std::runtime_error {
    using std::runtime_error::runtime_error;
  };

  Json();
  Json(const Json& other);
  Json(Json&& other) noexcept;
  Json& operator=(const Json& other);
  Json& operator=(Json&& other) noexcept;
  ~Json();

  Json(std::nullptr_t);
  Json(std::string text);
  Json(std::string_view text);
  Json(const char* text);
  template <class T>
  requires std::is_arithmetic_v<T> Json(T number) : Json(Number<T>{number}) {}
  template <class T>
  Json(const std::vector<T>& list) : Json(array()) {
    for (const auto& value : list) push_back(Json(value));
  }
  template <class T, std::size_t N>
  Json(const std::array<T, N>& list) : Json(array()) {
    for (const auto& value : list) push_back(Json(value));
  }
  template <class T>
  Json(const std::map<std::string, T>& members) : Json(object()) {
    for (const auto& [key, value] : members) (*this)[key] = value;
  }
  /// An object where every item is a pair whose first is a string, {{"a", 1}, {"b", 2}}; else a
  /// list. Only the outermost braces round a single value may be read as the value itself:
  /// array({value}) is a list of it to every compiler.
  Json(std::initializer_list<Item> items);

  static Json array();
  static Json array(std::initializer_list<Item> items);
  static Json object();

  bool is_null() const { return holds<std::nullptr_t>(); }
  bool is_boolean() const { return holds<bool>(); }
  bool is_string() const { return holds<std::string>(); }
  bool is_array() const { return holds<std::vector<Json>>(); }
  bool is_object() const { return holds<std::vector<Member>>(); }
  bool is_number_unsigned() const { return holds<std::uint64_t>(); }
  bool is_number_integer() const { return is_number_unsigned() || holds<std::int64_t>(); }
  bool is_number() const { return is_number_integer() || holds<double>(); }

  /// Items of a list, members of an object, 0 for null, 1 for anything else.
  std::size_t size() const;
  bool empty() const { return size() == 0; }
  bool contains(std::string_view key) const { return find(key) != nullptr; }
  /// The value of a key, nullptr where it is absent or this is no object.
  const Json* find(std::string_view key) const;

  /// The value of a key or an index that must be there.
  const Json& at(std::string_view key) const;
  Json& at(std::string_view key);
  const Json& at(std::size_t index) const;
  Json& at(std::size_t index);
  const Json& operator[](const char* key) const { return at(std::string_view(key)); }
  const Json& operator[](const std::string& key) const { return at(std::string_view(key)); }
  template <std::integral I>
  const Json& operator[](I index) const {
    return at(static_cast<std::size_t>(index));
  }
  /// The value of a key, added as null where it is absent; null becomes an object.
  Json& operator[](const char* key) { return member(key); }
  Json& operator[](const std::string& key) { return member(key); }
  /// The value at an index; a list (or null) grows by nulls up to it.
  template <std::integral I>
  Json& operator[](I index) {
    return element(static_cast<std::size_t>(index));
  }
  const Json& front() const { return at(std::size_t{0}); }
  const Json& back() const { return at(size() - 1); }
  Json& back() { return at(size() - 1); }

  /// The value of a key as the type of `fallback`, which is taken where the key is absent.
  template <class T>
  T value(std::string_view key, const T& fallback) const {
    const Json* found = object_member(key);
    return found ? found->get<T>() : fallback;
  }
  std::string value(std::string_view key, const char* fallback) const {
    return value(key, std::string(fallback));
  }

  template <class T>
  T get() const {
    if constexpr (std::is_same_v<T, Json>) {
      return *this;
    } else {
      T out{};
      read(out);
      return out;
    }
  }
  template <JsonReadable T>
  operator T() const {
    return get<T>();
  }

  void push_back(Json value);
  /// Every member of an object is set here too.
  void update(const Json& members);
  void erase(std::string_view key);
  void erase(std::size_t index);

  /// Walks over the items of a list, the values of an object or a value by itself; null has none.
  template <class Item, class Pair>
  class Walk {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Json;
    using difference_type = std::ptrdiff_t;
    using pointer = Item*;
    using reference = Item&;

    Walk() = default;
    Walk(Item* item, Pair* member) : item_(item), member_(member) {}
    Item& operator*() const { return member_ ? member_->second : *item_; }
    Item* operator->() const { return &**this; }
    Walk& operator++() {
      member_ ? void(++member_) : void(++item_);
      return *this;
    }
    Walk operator++(int) {
      Walk before = *this;
      ++*this;
      return before;
    }
    bool operator==(const Walk&) const = default;

   private:
    Item* item_ = nullptr;
    Pair* member_ = nullptr;
  };
  Walk<Json, Member> begin();
  Walk<Json, Member> end();
  Walk<const Json, const Member> begin() const;
  Walk<const Json, const Member> end() const;
  /// The members of an object, in order; none for null.
  const std::vector<Member>& items() const;
  std::vector<Member>& items();

  /// The text: in one line, or indented by as many spaces. A number that is not finite is null.
  std::string dump(int indent = -1) const;
  /// A text that is known to be right; parse_json() is for input.
  static Json parse(std::string_view text);

  friend bool operator==(const Json& a, const Json& b) { return equal(a, b); }
  template <class T>
  requires std::is_arithmetic_v<T>
  friend bool operator==(const Json& a, T b) { return equal(a, Json(b)); }
  friend std::ostream& operator<<(std::ostream& out, const Json& json);

 private:
  template <class T>
  struct Number {
    T value;
  };
  template <class T>
  explicit Json(Number<T> n) {
    if constexpr (std::is_same_v<T, bool>) {
      value_ = n.value;
    } else if constexpr (std::is_floating_point_v<T>) {
      value_ = static_cast<double>(n.value);
    } else if constexpr (std::is_unsigned_v<T>) {
      value_ = static_cast<std::uint64_t>(n.value);
    } else {
      value_ = static_cast<std::int64_t>(n.value);
    }
  }

  template <class T>
  bool holds() const {
    return std::holds_alternative<T>(value_);
  }
  template <class Pair, class Self>
  static Walk<Self, Pair> place(Self& self, std::size_t index);
  static bool equal(const Json& a, const Json& b);
  const Json* object_member(std::string_view key) const;
  Json& member(std::string_view key);
  Json& element(std::size_t index);

  double real() const;
  std::int64_t whole() const;
  void read(bool& out) const;
  void read(std::string& out) const;
  template <std::floating_point T>
  void read(T& out) const {
    out = static_cast<T>(real());
  }
  template <std::integral T>
  void read(T& out) const {
    out = static_cast<T>(whole());
  }
  template <class T>
  void read(std::vector<T>& out) const {
    for (const Json& item : array_items()) out.push_back(item.get<T>());
  }
  template <class T>
  void read(std::map<std::string, T>& out) const {
    for (const auto& [key, item] : object_items()) out[key] = item.template get<T>();
  }
  const std::vector<Json>& array_items() const;
  const std::vector<Member>& object_items() const;

  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string,
               std::vector<Json>, std::vector<Member>>
      value_;
};

/// What stands between the braces of a Json. A type of its own: round one element of Json itself,
/// {"a", {json}}, compilers differ in whether braces make a list or copy the element.
class Json::Item {
 public:
  template <class T>
  requires(!std::same_as<std::remove_cvref_t<T>, Item> && std::constructible_from<Json, T>)
  Item(T&& value) : value_(std::forward<T>(value)) {}
  Item(std::initializer_list<Item> items) : value_(items) {}

  const Json& value() const { return value_; }

 private:
  Json value_;
};

/// Parses one JSON document. Duplicate keys, comments, nesting beyond 64 levels, invalid UTF-8 and
/// trailing text are errors with code `exit`, named by `where` with line and column.
Json parse_json(std::string_view text, const std::string& where, Exit exit);

/// Reads and parses a file of at most 64 MB; a missing or unreadable file is an error with code
/// `exit`.
Json read_json(const std::filesystem::path& path, Exit exit);

}  // namespace dcnn
