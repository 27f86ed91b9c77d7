// SPDX-License-Identifier: Apache-2.0
// An ONNX graph as it grows node by node. Numbers of fields and types are those of onnx.proto.
#pragma once

#include <string>
#include <vector>

#include "dcnn/core/parallel.h"
#include "models/onnx/message.h"

namespace dcnn::onnx {

/// An attribute of a node: whole numbers or a word.
Message whole(const std::string& name, std::int64_t value);
Message wholes(const std::string& name, const std::vector<Index>& values);
Message word(const std::string& name, const std::string& value);

class Graph {
 public:
  /// A constant by a name of its own, which is returned.
  std::string constant(const std::string& hint, const std::vector<Index>& shape,
                       const std::vector<float>& values);
  std::string constant(const std::string& hint, const std::vector<Index>& values);

  /// Adds a node; returns the name of its output. An empty input is one left out.
  std::string node(const std::string& type, const std::vector<std::string>& inputs,
                   const std::vector<Message>& attributes = {});
  /// The same for a node of which the `count` outputs from `first` on are wanted.
  std::vector<std::string> node_outputs(const std::string& type, std::size_t first,
                                        std::size_t count, const std::vector<std::string>& inputs,
                                        const std::vector<Message>& attributes);

  /// A state that goes on from call to call: the file has a float tensor `name` (1, N, units) more
  /// as its input, and another one as its output, the value named `next`.
  void carry(const std::string& name, Index units, const std::string& next);

  /// The whole file: float tensors `input` (N, in…) and `output` (N, out…), whose value is the one
  /// named `result`.
  std::string file(const std::string& input, const std::vector<Index>& in,
                   const std::string& result, const std::string& output,
                   const std::vector<Index>& out);

 private:
  std::string fresh(const std::string& hint);
  void add(const std::string& type, const std::vector<std::string>& inputs,
           const std::vector<std::string>& outputs, const std::vector<Message>& attributes);

  Message nodes_and_constants_, states_;
  int names_ = 0;
};

}  // namespace dcnn::onnx
