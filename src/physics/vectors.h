// Reading lists of three from JSON.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/core/options.h"

namespace dcnn {

/// A list of `size` finite numbers, or `fallback` where the key is absent.
Eigen::VectorXd read_list(Options& options, const std::string& key,
                          const Eigen::VectorXd& fallback);
Json to_list(const Eigen::VectorXd& values);

}  // namespace dcnn
