// SPDX-License-Identifier: Apache-2.0
// The numbers of an effect that was found, for the words of its row in the catalogue.
#pragma once

#include <string>
#include <vector>

namespace dcnn {

struct FoundNumber {
  std::string stem;                           ///< its published name without its unit, "fc"
  std::string unit;                           ///< as it is read, "N·m"
  double value = 0.0, low = 0.0, high = 0.0;  ///< the 95 % interval, NaN where there is none
  bool is_told = true;                        ///< its size is known to within a factor
};

class FoundNumbers {
 public:
  /// `on_machine`: on an axis of a machine.
  FoundNumbers(std::vector<FoundNumber> numbers, bool on_machine)
      : numbers_(std::move(numbers)), on_machine_(on_machine) {}

  bool on_machine() const { return on_machine_; }
  const std::vector<FoundNumber>& all() const { return numbers_; }
  bool has(const std::string& stem) const { return find(stem) != nullptr; }
  /// 0 where it is not there.
  double value(const std::string& stem) const;
  std::string unit(const std::string& stem) const;
  bool is_told(const std::string& stem) const;
  /// Whether its interval holds a value.
  bool holds(const std::string& stem, double at) const;
  /// Root of the sum of squares of those whose stems begin so and whose units are this one.
  double length(const std::string& begin, const std::string& unit) const;

  /// "0.4 N"
  std::string operator()(const std::string& stem) const;
  /// "0.4": times a factor, without a unit.
  std::string plain(const std::string& stem, double factor = 1.0) const;
  /// Times a factor and without its sign, over another unit.
  std::string size(const std::string& stem, double factor = 1.0, const std::string& per = "") const;
  /// "0.3 N", "0.3 N and 12 mN·m" or "12 mN·m": the vectors of those whose stems begin so; `per`
  /// ends their units, as "/s", and they are told times a factor.
  std::string push(const std::string& begin, const std::string& per = "", double times = 1.0) const;

 private:
  const FoundNumber* find(const std::string& stem) const;
  std::vector<FoundNumber> numbers_;
  bool on_machine_;
};

/// "12 mm" of 0.012 and "mm".
std::string in_thousandths(double value, const std::string& unit);
/// "35 g" or "1.2 kg".
std::string mass_text(double kg);
/// "4 mN" or "0.3 N".
std::string force_text(double newtons);

}  // namespace dcnn
