// SPDX-License-Identifier: Apache-2.0
// The layers of a network as nodes of an ONNX graph.
#pragma once

#include <string>

#include "dcnn/nn/network.h"
#include "models/onnx/graph.h"

namespace dcnn::onnx {

/// Adds the layers of network.folded() behind the value `input`, (N, sample…) with images
/// channels-first; returns the name of the result (N, outputs). `carries`: see to_onnx().
std::string add_layers(const Network& network, Graph& graph, const std::string& input,
                       bool carries = false);

/// The shape of one sample there: (C, H, W) of an image.
Shape sample_shape(const Network& network);

}  // namespace dcnn::onnx
