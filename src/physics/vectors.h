// SPDX-License-Identifier: Apache-2.0
// Reading lists of three from JSON.
#pragma once

#include <Eigen/Dense>
#include <limits>
#include <string>
#include <vector>

#include "dcnn/core/options.h"

namespace dcnn {

/// A list of numbers of magnitude `most` at most, as many as `fallback` has, or that where the key
/// is absent.
Eigen::VectorXd read_list(Options& options, const std::string& key, const Eigen::VectorXd& fallback,
                          double most = std::numeric_limits<double>::max());
Json to_list(const Eigen::VectorXd& values);

}  // namespace dcnn
