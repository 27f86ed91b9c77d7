// SPDX-License-Identifier: Apache-2.0
// What our tools use of CLI11's options, compiled once: in every program its headers cost seconds.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "support/file_kind.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace dcnn {

struct OptionRow;

/// An option of Tool::option() or Tool::flag(); copies name the same one.
class Option {
 public:
  Option(CLI::Option& option, OptionRow& row) : option_(&option), row_(&row) {}

  Option required() const;
  /// --help shows what the variable holds now.
  Option with_default() const;
  Option between(int low, int high) const;
  /// Finite and above 0, and where `most` is given no more than that.
  Option positive(std::optional<int> most = std::nullopt) const;
  Option not_negative() const;
  Option one_of(const std::vector<std::string>& words) const;
  Option one_of(std::initializer_list<double> numbers) const;
  /// Takes exactly so many values; `counted` says what they are: "numbers rx ry rz [rad]".
  Option values(int count, const std::string& counted) const;
  /// Its files are of one of these kinds; another one, where it is recognised, is refused by name.
  Option holds(const std::vector<FileKind>& kinds) const;
  /// Stands without a value too.
  Option value_optional() const;
  Option separated_by_commas() const;
  /// What --help calls its value: "FILE", "HOST:PORT".
  Option called(const std::string& value) const;
  Option needs(Option other) const;
  Option excludes(Option other) const;
  /// --help lists it under this heading.
  Option group(const std::string& heading) const;

  /// "--out".
  const std::string& name() const;
  /// Whether the command line has it.
  bool given() const;

 private:
  CLI::Option* option_;
  OptionRow* row_;
};

}  // namespace dcnn
