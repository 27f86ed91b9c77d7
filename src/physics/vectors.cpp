// SPDX-License-Identifier: Apache-2.0
#include "physics/vectors.h"

#include <cmath>

namespace dcnn {

Eigen::VectorXd read_list(Options& options, const std::string& key, const Eigen::VectorXd& fallback,
                          double most) {
  const std::vector<double> given(fallback.begin(), fallback.end());
  const auto list = options.get(key, given);
  if (list.size() != given.size()) {
    options.reject(key, "must be a list of ", given.size(), " numbers, not of ", list.size());
  }
  const Eigen::VectorXd values =
      Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
  if (!values.allFinite()) options.reject(key, "must hold finite numbers");
  for (const double value : values) {
    if (std::abs(value) > most) {
      options.reject(key, "must hold numbers between ", -most, " and ", most, ", not ", value);
    }
  }
  return values;
}

Json to_list(const Eigen::VectorXd& values) {
  return std::vector<double>(values.begin(), values.end());
}

}  // namespace dcnn
