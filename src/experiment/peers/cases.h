// SPDX-License-Identifier: Apache-2.0
// What is compared: networks and samples, as files for the helpers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/experiment/peers.h"
#include "dcnn/nn/network.h"

namespace dcnn {

/// What one call has to do with the one before; where it has, one sample a call alone.
enum class Succession {
  kNone,
  kSlides,   ///< the samples are a window (rows, …) that slides by one row a call
  kCarries,  ///< the samples are rows, the state goes on from call to call, zero before the first
};

struct PeerCase {
  std::string name;
  Network network;  ///< folded
  Succession succession = Succession::kNone;
};

/// The networks of the request's models, or those of the paper: dcnn valid, dcnn same, lstm (one
/// row), a step of it that goes on from its state, lstm-25, the same online, ffnn-s, ffnn-m. A
/// model without a plain network becomes a note.
std::vector<PeerCase> peer_cases(const PeersRequest& request, std::vector<std::string>& notes);

/// Whether request.networks has this name, or none.
bool is_asked(const PeersRequest& request, const std::string& network);

/// Multiply-adds of one prediction; those with the zeros around an image and with the zero state
/// before a window do not count; `carries`: before the window there is a state.
double products(const Network& network, bool carries = false);

/// Standard normal inputs of so many samples.
Tensor drawn_samples(const Network& network, Index samples, std::uint64_t seed);
/// Windows that slide over standard normal rows, of which the first ones are all the same.
Tensor drawn_windows(const Network& network, Index samples, std::uint64_t seed);

/// Writes the files of a case into a folder: samples as floats, the network as ONNX and as tensors
/// by their names with metadata `layers`, `input` and `carries`; and an ONNX file that does nothing
/// with a value and as many states.
inline constexpr const char *kSamplesFile = "samples.f32", *kOnnxFile = "network.onnx",
                            *kNetworkFile = "network.safetensors", *kNothingFile = "nothing.onnx";
void write_case(const std::filesystem::path& folder, const PeerCase& what, const Tensor& x);

}  // namespace dcnn
