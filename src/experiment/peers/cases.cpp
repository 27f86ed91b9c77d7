// SPDX-License-Identifier: Apache-2.0
#include "experiment/peers/cases.h"

#include <algorithm>

#include "dcnn/core/file.h"
#include "dcnn/models/onnx.h"
#include "experiment/peers/training.h"
#include "models/onnx/graph.h"
#include "models/shallow_network.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

/// Taps of a convolution that meet the image, along one axis, summed over output places.
Index taps_inside(Index in, Index out, Index window, Index before) {
  Index count = 0;
  for (Index place = 0; place < out; ++place) {
    for (Index tap = 0; tap < window; ++tap) {
      const Index at = place - before + tap;
      count += at >= 0 && at < in;
    }
  }
  return count;
}

double convolution_products(const Json& layer, const Shape& in, const Shape& out) {
  const auto window = layer.value("window", std::vector<Index>{2, 2});
  const bool same = layer.value("padding", "same") == "same";
  const Index before_h = same ? (window[0] - 1) / 2 : 0, before_w = same ? (window[1] - 1) / 2 : 0;
  return static_cast<double>(taps_inside(in[0], out[0], window[0], before_h) *
                             taps_inside(in[1], out[1], window[1], before_w) * in[2] * out[2]);
}

double lstm_products(const Shape& in, Index units, bool carries) {
  const double t = static_cast<double>(in[0]), gates = 4.0 * static_cast<double>(units);
  const double recurrent = carries ? t : t - 1;
  return gates * (t * static_cast<double>(in[1]) + recurrent * static_cast<double>(units));
}

/// Tanh layers and a linear one, as FFNN-S and FFNN-M have them.
PeerCase shallow_case(const std::string& name, const std::vector<Index>& hidden, Rng& rng) {
  Json layers = Json::array();
  for (const Index units : hidden) {
    layers.push_back({{"kind", "linear"}, {"outputs", units}});
    layers.push_back({{"kind", "tanh"}});
  }
  layers.push_back({{"kind", "linear"}, {"outputs", 3}});
  return {name, Network(layers, {15}, rng)};
}

std::vector<PeerCase> paper_cases(std::uint64_t seed) {
  Rng rng(seed);
  std::vector<PeerCase> cases;
  for (const Task& task : {dcnn_task("valid"), dcnn_task("same"), lstm_task(1), lstm_task(25)}) {
    cases.push_back({task.name, Network(task.layers, task.input, rng).folded()});
  }
  cases.push_back({"lstm-25-online", cases.back().network.folded(), Succession::kSlides});
  cases.push_back({"lstm-step", cases[2].network.folded(), Succession::kCarries});
  cases.push_back(shallow_case("ffnn-s", {20}, rng));
  cases.push_back(shallow_case("ffnn-m", {9, 6}, rng));
  return cases;
}

/// As ONNX: one value, and the state of an LSTM, as they were.
std::string nothing(bool carries) {
  onnx::Graph graph;
  for (const char* state : {"h", "c"}) {
    if (carries) graph.carry(state, kLstmUnits, graph.node("Identity", {state}));
  }
  return graph.file("input", {1}, "input", "output", {1});
}

}  // namespace

bool is_asked(const PeersRequest& request, const std::string& network) {
  const auto& names = request.networks;
  return names.empty() || std::ranges::find(names, network) != names.end();
}

std::vector<PeerCase> peer_cases(const PeersRequest& request, std::vector<std::string>& notes) {
  if (request.models.empty()) {
    auto cases = paper_cases(request.seed);
    std::erase_if(cases, [&](const PeerCase& c) { return !is_asked(request, c.name); });
    return cases;
  }
  std::vector<PeerCase> cases;
  for (const auto& path : request.models) {
    const Identifier identifier = read_identifier(path);
    const std::string file = path.filename().string();
    if (auto network = identifier.model->network()) {
      cases.push_back({file, std::move(*network)});
    } else {
      notes.push_back(file + ": " + identifier.name + " is no plain network, peers are not asked");
    }
  }
  return cases;
}

double products(const Network& network, bool carries) {
  double sum = 0.0;
  for (std::size_t i = 0; i < network.layers().size(); ++i) {
    const Json& layer = network.layers()[i];
    const Shape &in = network.shapes()[i], &out = network.shapes()[i + 1];
    const auto kind = layer.at("kind").get<std::string>();
    if (kind == "conv2d") sum += convolution_products(layer, in, out);
    if (kind == "lstm") sum += lstm_products(in, layer.value("units", out.back()), carries);
    if (kind == "linear") sum += static_cast<double>(element_count(in) * element_count(out));
  }
  return sum;
}

Tensor drawn_samples(const Network& network, Index samples, std::uint64_t seed) {
  Shape shape = network.input();
  shape.insert(shape.begin(), samples);
  Tensor x(shape);
  Rng rng({seed, 0x5a3});
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  return x;
}

Tensor drawn_windows(const Network& network, Index samples, std::uint64_t seed) {
  Tensor x = drawn_samples(network, samples, seed);
  const Index cells = x.size() / samples, row = cells / network.input()[0];
  for (Index k = row; k < cells; ++k) x.data()[k] = x.data()[k - row];
  for (Index i = 1; i < samples; ++i) {
    Real* window = x.data() + i * cells;
    std::copy_n(window - cells + row, cells - row, window);
  }
  return x;
}

void write_case(const std::filesystem::path& folder, const PeerCase& what, const Tensor& x) {
  const Network& network = what.network;
  const bool carries = what.succession == Succession::kCarries;
  const std::vector<float> values(x.values().begin(), x.values().end());
  write_file(folder / kSamplesFile,
             {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
  write_file(folder / kOnnxFile, to_onnx(network, carries));
  write_file(folder / kNothingFile, nothing(carries));
  Container file;
  file.metadata["layers"] = network.layers().dump();
  file.metadata["input"] = Json(network.input()).dump();
  file.metadata["carries"] = Json(carries).dump();
  store_tensors(network.state(), "", file);
  write_container(folder / kNetworkFile, file);
}

}  // namespace dcnn
