// SPDX-License-Identifier: Apache-2.0
// ONNX files taken apart again: the wire format, the graph, and weights where they belong.
#include "dcnn/models/onnx.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "nn/dcnn_layers.h"

namespace dcnn {
namespace {

/// A message as fields by number, in order: numbers as text, the rest as bytes.
struct Field {
  int number;
  std::string bytes;
  std::uint64_t value = 0;
};

std::vector<Field> fields(std::string_view bytes) {
  std::vector<Field> found;
  std::size_t at = 0;
  const auto varint = [&] {
    std::uint64_t value = 0;
    for (int shift = 0;; shift += 7) {
      const auto byte = static_cast<unsigned char>(bytes.at(at++));
      value |= std::uint64_t{byte & 0x7fU} << shift;
      if (byte < 0x80) return value;
    }
  };
  while (at < bytes.size()) {
    const std::uint64_t key = varint();
    Field field{static_cast<int>(key >> 3), {}, varint()};
    if ((key & 7) == 2) {
      field.bytes = bytes.substr(at, field.value);
      at += field.value;
    } else {
      EXPECT_EQ(key & 7, 0U);
    }
    found.push_back(std::move(field));
  }
  EXPECT_EQ(at, bytes.size());
  return found;
}

std::vector<std::string> all(const std::vector<Field>& message, int number) {
  std::vector<std::string> found;
  for (const Field& field : message) {
    if (field.number == number) found.push_back(field.bytes);
  }
  return found;
}

std::string one(const std::vector<Field>& message, int number) {
  const auto found = all(message, number);
  EXPECT_EQ(found.size(), 1U) << number;
  return found.empty() ? "" : found[0];
}

struct DecodedTensor {
  Shape shape;
  std::vector<float> values;
};

struct Decoded {
  std::vector<std::string> operators;
  std::vector<std::vector<std::string>> inputs;
  std::map<std::string, DecodedTensor> constants;
};

Decoded decoded(const std::string& bytes) {
  const auto model = fields(bytes);
  const auto graph = fields(one(model, 7));
  Decoded result;
  for (const auto& node : all(graph, 1)) {
    result.operators.push_back(one(fields(node), 4));
    result.inputs.push_back(all(fields(node), 1));
  }
  for (const auto& constant : all(graph, 5)) {
    const auto tensor = fields(constant);
    DecodedTensor values;
    for (const Field& field : tensor) {
      if (field.number == 1) values.shape.push_back(static_cast<Index>(field.value));
    }
    const std::string raw = one(tensor, 9);
    values.values.resize(raw.size() / sizeof(float));
    std::memcpy(values.values.data(), raw.data(), values.values.size() * sizeof(float));
    result.constants[one(tensor, 8)] = std::move(values);
  }
  return result;
}

Network network(const Json& layers, const Shape& input) {
  Rng rng(3);
  return {layers, input, rng};
}

TEST(Onnx, SaysItsVersionsAndTheShapesOfInputAndOutput) {
  const auto model = fields(to_onnx(network(dcnn_layers("same"), {15, 5, 1})));
  for (const Field& field : model) {
    if (field.number != 1) continue;
    EXPECT_EQ(field.value, static_cast<std::uint64_t>(kOnnxIrVersion));
  }
  const auto opset = fields(one(model, 8));
  EXPECT_EQ(opset.back().value, static_cast<std::uint64_t>(kOnnxOpset));
  const auto graph = fields(one(model, 7));
  EXPECT_EQ(one(fields(one(graph, 11)), 1), "input");
  const auto output = fields(one(graph, 12));
  EXPECT_EQ(one(output, 1), "output");
  const auto tensor = fields(one(fields(one(output, 2)), 1));
  const auto extents = all(fields(one(tensor, 2)), 1);
  ASSERT_EQ(extents.size(), 2U);
  EXPECT_EQ(one(fields(extents[0]), 2), "N");
  EXPECT_EQ(fields(extents[1]).at(0).value, 3U);
}

TEST(Onnx, FoldsBatchNormAndLeavesOutDropout) {
  const Decoded graph = decoded(to_onnx(network(dcnn_layers("valid"), {15, 5, 1})));
  const std::vector<std::string> wanted{"Conv", "Relu", "Conv",    "Relu", "Conv",    "Relu",
                                        "Conv", "Relu", "Flatten", "Gemm", "Identity"};
  EXPECT_EQ(graph.operators, wanted);
}

TEST(Onnx, PutsFiltersAndChannelsFirst) {
  const Network net =
      network({{{"kind", "conv2d"}, {"filters", 3}, {"padding", "valid"}}}, {4, 4, 2});
  const Decoded graph = decoded(to_onnx(net));
  const DecodedTensor& kernel = graph.constants.at(graph.inputs[0][1]);
  ASSERT_EQ(kernel.shape, (Shape{3, 2, 2, 2}));
  const Tensor& ours = net.state()[0].tensor;  // (2, 2, 2, 3)
  for (Index f = 0; f < 3; ++f) {
    for (Index c = 0; c < 2; ++c) {
      for (Index tap = 0; tap < 4; ++tap) {
        EXPECT_EQ(kernel.values[static_cast<std::size_t>((f * 2 + c) * 4 + tap)],
                  ours.data()[(tap * 2 + c) * 3 + f]);
      }
    }
  }
}

TEST(Onnx, TurnsTheWeightsAfterAFlattenedImage) {
  const Network net =
      network({{{"kind", "flatten"}}, {{"kind", "linear"}, {"outputs", 1}}}, {2, 1, 3});
  const Decoded graph = decoded(to_onnx(net));
  const auto& values = graph.constants.at(graph.inputs[1][1]).values;
  const Real* ours = net.state()[0].tensor.data();  // place·3 + channel
  EXPECT_EQ(values, (std::vector<float>{ours[0], ours[3], ours[1], ours[4], ours[2], ours[5]}));
}

TEST(Onnx, RestoresTheOrderOfAFlattenedImageThatNobodyTurns) {
  const Decoded graph = decoded(to_onnx(network({{{"kind", "flatten"}}}, {2, 2, 3})));
  EXPECT_EQ(graph.operators,
            (std::vector<std::string>{"Flatten", "Reshape", "Transpose", "Flatten", "Identity"}));
}

TEST(Onnx, OrdersTheGatesOfAnLstm) {
  const Network net = network({{{"kind", "lstm"}, {"units", 2}}}, {3, 1});
  const Decoded graph = decoded(to_onnx(net));
  EXPECT_EQ(graph.operators,
            (std::vector<std::string>{"Transpose", "LSTM", "Squeeze", "Identity"}));
  const Real* ours = net.state()[0].tensor.data();  // i i f f g g o o
  const auto& values = graph.constants.at(graph.inputs[1][1]).values;
  EXPECT_EQ(values, (std::vector<float>{ours[0], ours[1], ours[6], ours[7], ours[2], ours[3],
                                        ours[4], ours[5]}));
  EXPECT_EQ(graph.constants.at(graph.inputs[1][3]).shape, (Shape{1, 16}));
}

}  // namespace
}  // namespace dcnn
