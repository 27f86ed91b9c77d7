// SPDX-License-Identifier: Apache-2.0
#include "support/option.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "dcnn/core/options.h"
#include "support/option_table.h"

namespace dcnn {
namespace {

bool is_number(const std::string& text, double* value) {
  return CLI::detail::lexical_cast(text, *value);
}

/// A check of a number that explains itself: "5000 is not between 1 and 1024".
CLI::Validator number_check(const std::string& wanted, std::function<bool(double)> ok) {
  return CLI::Validator(
      [wanted, ok = std::move(ok)](const std::string& text) {
        double value = 0.0;
        if (!is_number(text, &value)) return "'" + text + "' is not a number";
        return ok(value) ? std::string() : text + " is not " + wanted;
      },
      "");
}

std::string joined(const std::vector<std::string>& words) {
  std::string list;
  for (const auto& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

}  // namespace

Option Option::required() const {
  option_->required();
  row_->required = true;
  return *this;
}

Option Option::with_default() const {
  option_->capture_default_str();
  row_->standard = option_->get_default_str();
  if (row_->standard.starts_with("[")) {  // CLI11 shows lists as [1,5,10]
    row_->standard = row_->standard.substr(1, row_->standard.size() - 2);
  }
  return *this;
}

Option Option::between(int low, int high) const {
  const std::string bounds = std::to_string(low) + " and " + std::to_string(high);
  option_->check(
      number_check("between " + bounds, [=](double v) { return v >= low && v <= high; }));
  row_->bounds = std::to_string(low) + " to " + std::to_string(high);
  return *this;
}

Option Option::positive(std::optional<int> most) const {
  if (most) {
    const std::string bound = "at most " + std::to_string(*most);
    option_->check(number_check("greater than 0 and " + bound,
                                [most](double v) { return v > 0.0 && v <= *most; }));
    row_->bounds = bound;
  } else {
    option_->check(
        number_check("greater than 0", [](double v) { return v > 0.0 && std::isfinite(v); }));
  }
  return *this;
}

Option Option::not_negative() const {
  option_->check(number_check("0 or greater", [](double v) { return v >= 0.0; }));
  return *this;
}

Option Option::one_of(const std::vector<std::string>& words) const {
  option_->check(CLI::Validator(
      [words](const std::string& text) {
        if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
        const std::string near = nearest_word(text, words);
        return "'" + text + "' is none of " + joined(words) +
               (near.empty() ? "" : "; did you mean '" + near + "'?");
      },
      ""));
  row_->choices = words;
  row_->value = "WORD";
  return *this;
}

Option Option::one_of(std::initializer_list<double> numbers) const {
  std::vector<std::string> words;
  for (const double number : numbers) words.push_back(CLI::detail::to_string(number));
  option_->check(
      number_check("one of " + joined(words), [set = std::vector<double>(numbers)](double v) {
        return std::find(set.begin(), set.end(), v) != set.end();
      }));
  row_->choices = words;
  return *this;
}

Option Option::value_optional() const {
  option_->expected(0, 1);
  row_->optional_value = true;
  return *this;
}

Option Option::values(int count, const std::string& counted) const {
  option_->expected(count);
  row_->count = count;
  row_->counted = counted;
  return *this;
}

Option Option::holds(const std::vector<FileKind>& kinds) const {
  row_->kinds = kinds;
  return *this;
}

Option Option::separated_by_commas() const {
  option_->delimiter(',');
  return *this;
}

Option Option::called(const std::string& value) const {
  row_->value = value;
  return *this;
}

Option Option::needs(Option other) const {
  option_->needs(other.option_);
  return *this;
}

Option Option::excludes(Option other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::group(const std::string& heading) const {
  row_->group = heading;
  return *this;
}

const std::string& Option::name() const { return row_->names.back(); }

bool Option::given() const { return option_->count() > 0; }

}  // namespace dcnn
