// SPDX-License-Identifier: Apache-2.0
#include "models/onnx/graph.h"

#include <bit>
#include <cassert>

#include "dcnn/core/tensor.h"
#include "dcnn/models/onnx.h"

namespace dcnn::onnx {
namespace {

static_assert(std::endian::native == std::endian::little, "ONNX's raw data is little-endian");

constexpr int kFloat = 1, kInt64 = 7;                                     // TensorProto.DataType
constexpr int kAttributeInt = 2, kAttributeText = 3, kAttributeInts = 7;  // AttributeProto

constexpr Index kFree = -1;  // the number of samples

Message value_info(const std::string& name, const std::vector<Index>& shape) {
  Message dimensions;
  for (const Index extent : shape) {
    dimensions.message(1, extent == kFree ? Message().bytes(2, "N") : Message().number(1, extent));
  }
  const Message tensor = Message().number(1, kFloat).message(2, dimensions);
  return Message().bytes(1, name).message(2, Message().message(1, tensor));
}

template <class T>
Message tensor(const std::string& name, int type, const std::vector<Index>& shape,
               const std::vector<T>& values) {
  assert(static_cast<Index>(values.size()) == element_count(shape));
  Message proto;
  for (const Index extent : shape) proto.number(1, extent);
  proto.number(2, type).bytes(8, name);
  return proto.bytes(9, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

}  // namespace

Message whole(const std::string& name, std::int64_t value) {
  return Message().bytes(1, name).number(3, value).number(20, kAttributeInt);
}

Message wholes(const std::string& name, const std::vector<Index>& values) {
  Message proto = Message().bytes(1, name);
  for (const Index value : values) proto.number(8, value);
  return proto.number(20, kAttributeInts);
}

Message word(const std::string& name, const std::string& value) {
  return Message().bytes(1, name).bytes(4, value).number(20, kAttributeText);
}

std::string Graph::fresh(const std::string& hint) { return hint + std::to_string(names_++); }

std::string Graph::constant(const std::string& hint, const std::vector<Index>& shape,
                            const std::vector<float>& values) {
  const std::string name = fresh(hint);
  nodes_and_constants_.message(5, tensor(name, kFloat, shape, values));
  return name;
}

std::string Graph::constant(const std::string& hint, const std::vector<Index>& values) {
  const std::string name = fresh(hint);
  nodes_and_constants_.message(5,
                               tensor(name, kInt64, {static_cast<Index>(values.size())}, values));
  return name;
}

std::string Graph::node(const std::string& type, const std::vector<std::string>& inputs,
                        const std::vector<Message>& attributes) {
  return node_outputs(type, 0, 1, inputs, attributes).front();
}

std::vector<std::string> Graph::node_outputs(const std::string& type, std::size_t first,
                                             std::size_t count,
                                             const std::vector<std::string>& inputs,
                                             const std::vector<Message>& attributes) {
  std::vector<std::string> outputs(first), wanted;
  for (std::size_t k = 0; k < count; ++k) wanted.push_back(fresh("y"));
  outputs.insert(outputs.end(), wanted.begin(), wanted.end());
  add(type, inputs, outputs, attributes);
  return wanted;
}

void Graph::carry(const std::string& name, Index units, const std::string& next) {
  states_.message(11, value_info(name, {1, kFree, units}));
  states_.message(12, value_info(next, {1, kFree, units}));
}

void Graph::add(const std::string& type, const std::vector<std::string>& inputs,
                const std::vector<std::string>& outputs, const std::vector<Message>& attributes) {
  Message proto;
  for (const auto& name : inputs) proto.bytes(1, name);
  for (const auto& name : outputs) proto.bytes(2, name);
  proto.bytes(4, type);
  for (const auto& attribute : attributes) proto.message(5, attribute);
  nodes_and_constants_.message(1, proto);
}

std::string Graph::file(const std::string& input, const std::vector<Index>& in,
                        const std::string& result, const std::string& output,
                        const std::vector<Index>& out) {
  add("Identity", {result}, {output}, {});
  const auto of_samples = [](std::vector<Index> shape) {
    shape.insert(shape.begin(), kFree);
    return shape;
  };
  Message graph = nodes_and_constants_;
  graph.bytes(2, "dcnn")
      .message(11, value_info(input, of_samples(in)))
      .message(12, value_info(output, of_samples(out)))
      .append(states_);
  Message model;
  model.number(1, kOnnxIrVersion).bytes(2, "dcnn").bytes(3, DCNN_VERSION).message(7, graph);
  return model.message(8, Message().bytes(1, "").number(2, kOnnxOpset)).str();
}

}  // namespace dcnn::onnx
