#include "support/option.h"

#include <CLI/CLI.hpp>

namespace dcnn {

Option Option::required() const { return option_->required(), *this; }
Option Option::with_default() const { return option_->capture_default_str(), *this; }
Option Option::between(int low, int high) const {
  return option_->check(CLI::Range(low, high)), *this;
}
Option Option::positive() const { return option_->check(CLI::PositiveNumber), *this; }
Option Option::not_negative() const { return option_->check(CLI::NonNegativeNumber), *this; }
Option Option::one_of(const std::vector<std::string>& words) const {
  return option_->check(CLI::IsMember(words)), *this;
}
Option Option::one_of(std::initializer_list<double> numbers) const {
  return option_->check(CLI::IsMember(std::vector<double>(numbers))), *this;
}
Option Option::value_optional() const { return option_->expected(0, 1), *this; }
Option Option::values(int count) const { return option_->expected(count), *this; }
Option Option::separated_by_commas() const { return option_->delimiter(','), *this; }
Option Option::needs(Option other) const { return option_->needs(other.option_), *this; }
Option Option::excludes(Option other) const { return option_->excludes(other.option_), *this; }
Option Option::group(const std::string& heading) const { return option_->group(heading), *this; }
bool Option::given() const { return option_->count() > 0; }

}  // namespace dcnn
