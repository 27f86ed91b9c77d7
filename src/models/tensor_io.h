// SPDX-License-Identifier: Apache-2.0
// Between tensors and the container of a file.
#pragma once

#include <string>
#include <vector>

#include "dcnn/models/container.h"
#include "dcnn/nn/layer.h"

namespace dcnn {

/// Adds every tensor under prefix + name.
void store_tensors(const std::vector<NamedTensor>& tensors, const std::string& prefix,
                   Container& file);

/// Fills every tensor from the file; one that is missing or of another shape is Error(kModel).
void load_tensors(const Container& file, const std::string& prefix,
                  const std::vector<NamedTensor>& tensors, const std::string& where);

/// The values of one stored tensor of exactly this type, else Error(kModel).
template <class T>
const std::vector<T>& stored_values(const Container& file, const std::string& name,
                                    const std::string& where) {
  const StoredTensor* tensor = file.find(name);
  const auto* values = tensor ? std::get_if<std::vector<T>>(&tensor->values) : nullptr;
  require(values != nullptr, Exit::kModel, where, ": tensor '", name,
          "' is missing or of another type; the file belongs to another model");
  return *values;
}

/// A stored tensor of numbers as a row.
Eigen::RowVectorXd stored_row(const Container& file, const std::string& name,
                              const std::string& where);

/// The entries of an Eigen vector.
template <class Vector>
std::vector<double> list_of(const Vector& v) {
  return {v.begin(), v.end()};
}

/// A metadata text, else Error(kModel).
const std::string& stored_text(const Container& file, const std::string& key,
                               const std::string& where);

}  // namespace dcnn
