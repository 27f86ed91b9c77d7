// SPDX-License-Identifier: Apache-2.0
// Networks and models as ONNX files, for other runtimes.
#pragma once

#include <string>

#include "dcnn/models/identifier.h"
#include "dcnn/nn/network.h"

namespace dcnn {

/// What the files say that they are: operators of opset 13, which every runtime since 2020 has.
inline constexpr int kOnnxOpset = 13, kOnnxIrVersion = 7;

/// The network at inference, batch norm folded: the bytes of an ONNX model from "input" (N,
/// sample…) to "output" (N, outputs). Images are channels-first there, (N, C, H, W): for one
/// channel the same values in the same order as ours. A layer ONNX has no counterpart for is
/// Error(kUsage). `carries`, for networks with one LSTM: its state goes on from call to call, "h"
/// and "c" (1, N, units) are further inputs and what they become further outputs.
std::string to_onnx(const Network& network, bool carries = false);

/// A trained model from "features" in SI units, (N, F), or (N, T, F) where it reads the last T
/// rows, to "targets" (N, targets) in their units: Eq. 7 or the standardisation is inside, making
/// features of poses and the part of a base simulator are not. Arithmetic is float throughout.
/// Error(kUsage) for kinds that are no plain network.
std::string to_onnx(const Identifier& identifier);

}  // namespace dcnn
