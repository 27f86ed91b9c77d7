// SPDX-License-Identifier: Apache-2.0
// How fields are built: functions of what the recordings hold, along an axis, whitened.
#pragma once

#include <functional>
#include <map>

#include "diagnosis/evidence/field.h"

namespace dcnn::evidence {

using Vector = Eigen::ArrayXd;
/// One value a sample, of each recording.
using Series = std::vector<Vector>;

inline constexpr const char* kLetters[3] = {"x", "y", "z"};
/// Of rates by their frames: base, sensor, and rates of turning ('w').
const std::map<char, std::string>& rate_words();

double rms(const Series& series);
Series mapped(const Series& series, const std::function<Vector(const Vector&)>& f);
Series product(const Series& a, const Series& b);

class FieldBuilder {
 public:
  FieldBuilder(const Grid& grid, const Signals& prediction)
      : grid_(grid), prediction_(prediction) {}

  const Case& study() const { return grid_.study(); }
  bool moves() const;
  template <class F>
  Series of_logs(const F& f) const {
    Series out;
    for (std::size_t k = 0; k < study().logs.size(); ++k) {
      out.emplace_back(f(study().logs[k].motion, k));
    }
    return out;
  }
  /// Velocity along an axis of the base ('b') or the sensor ('s'), or rate about one of the sensor
  /// ('w').
  Series rate_of(char frame, int axis) const;
  /// Of the predicted wrench.
  Series force_of(Index channel) const;

  /// A field of these functions along an axis of the sensor's wrench (0 to 5) or the base (0 to 2)
  /// …
  void add(const std::string& driver, const std::string& kind, const std::vector<Series>& functions,
           int axis, bool base);
  /// … along all axes of the base, or of what is measured …
  void add_all(const std::string& driver, const std::string& kind,
               const std::vector<Series>& functions, bool base);
  /// … and of odd and even functions of a signed quantity at several scales, of equal size each.
  void add_shapes(const std::string& driver, const Series& u, bool base);
  std::vector<Field> take() { return std::move(fields_); }

 private:
  Eigen::VectorXd column(const Series& size, int axis, bool base) const;

  const Grid& grid_;
  const Signals& prediction_;
  std::vector<Field> fields_;
};

/// What depends on the state of motion, and on its past and the clock.
void add_state_fields(FieldBuilder& builder);
void add_memory_fields(FieldBuilder& builder);

}  // namespace dcnn::evidence
