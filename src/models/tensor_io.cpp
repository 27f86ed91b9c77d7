// SPDX-License-Identifier: Apache-2.0
#include "models/tensor_io.h"

#include <algorithm>

namespace dcnn {

void store_tensors(const std::vector<NamedTensor>& tensors, const std::string& prefix,
                   Container& file) {
  for (const NamedTensor& t : tensors) {
    const auto values = t.tensor.values();
    file.tensors.push_back(
        {prefix + t.name, t.tensor.shape(), std::vector<Real>(values.begin(), values.end())});
  }
}

void load_tensors(const Container& file, const std::string& prefix,
                  const std::vector<NamedTensor>& tensors, const std::string& where) {
  for (const NamedTensor& t : tensors) {
    const auto& values = stored_values<Real>(file, prefix + t.name, where);
    require(file.find(prefix + t.name)->shape == t.tensor.shape(), Exit::kModel, where,
            ": tensor '", t.name, "' has another shape than the architecture says");
    std::copy(values.begin(), values.end(), t.tensor.data());
  }
}

const std::string& stored_text(const Container& file, const std::string& key,
                               const std::string& where) {
  const auto found = file.metadata.find(key);
  require(found != file.metadata.end(), Exit::kModel, where, ": metadata '", key,
          "' is missing; not a model of this program");
  return found->second;
}

Eigen::RowVectorXd stored_row(const Container& file, const std::string& name,
                              const std::string& where) {
  const auto& values = stored_values<double>(file, name, where);
  return Eigen::Map<const Eigen::RowVectorXd>(values.data(), static_cast<Index>(values.size()));
}

}  // namespace dcnn
