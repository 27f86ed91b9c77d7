// SPDX-License-Identifier: Apache-2.0
// dcnn-peer-onednn: oneDNN beside dcnn-bench. Every primitive chooses its own layouts, weights are
// reordered once, ReLU and tanh are part of the primitive before them.
#include <omp.h>

#include <algorithm>
#include <cstring>
#include <oneapi/dnnl/dnnl.hpp>

#include "peers/serve.h"

namespace dcnn::peers {
namespace {

using dnnl::memory;
using Tag = memory::format_tag;
using Dims = memory::dims;

memory::desc described(const Dims& dims, Tag tag) { return {dims, memory::data_type::f32, tag}; }

class OneDnnRunner final : public Runner {
 public:
  OneDnnRunner(const ExportedNetwork& network, Index batch)
      : network_(network), batch_(batch), outputs_(1) {
    const Shape& in = network.input;
    if (in.size() == 3) {
      sample_ = {in[2], in[0], in[1]};
      given_ = described({batch, in[2], in[0], in[1]}, Tag::nhwc);
    } else if (in.size() == 2) {
      given_ = described({in[0], batch, in[1]}, Tag::ntc);
    } else {
      given_ = described({batch, in[0]}, Tag::nc);
    }
    input_ = memory(given_, engine_, nullptr);
    flow_ = input_;
    for (layer_ = 0; layer_ < static_cast<Index>(network.layers.size()); ++layer_) add_layer();
    finish();
  }

  const float* run(const float* samples) override {
    input_.set_data_handle(const_cast<float*>(samples));
    for (const Step& step : steps_) step.primitive.execute(stream_, step.arguments);
    stream_.wait();
    for (const State& state : states_) state.go_on();
    return steps_.empty() ? samples : static_cast<const float*>(flow_.get_data_handle());
  }
  Index outputs() const override { return outputs_; }
  void begin() override {
    for (const State& state : states_) state.clear();
  }

 private:
  struct Step {
    dnnl::primitive primitive;
    std::unordered_map<int, memory> arguments;
  };

  /// Of an LSTM before and after a call; the primitive does not work in place.
  struct State {
    memory before, after;
    void clear() const { std::memset(before.get_data_handle(), 0, before.get_desc().get_size()); }
    void go_on() const {
      std::memcpy(before.get_data_handle(), after.get_data_handle(), before.get_desc().get_size());
    }
  };

  void add_layer() {
    const Json& layer = network_.layers[layer_];
    const auto kind = layer.at("kind").get<std::string>();
    if (kind == "conv2d") return add_convolution(layer);
    if (kind == "linear") return add_linear();
    if (kind == "lstm") return add_lstm();
    const bool nothing = kind == "flatten" || kind == "dropout" || kind == "relu" || kind == "tanh";
    require(nothing, Exit::kUsage, "no oneDNN primitive for a layer '", kind, "'");
  }

  /// The ReLU or tanh after this layer as part of it.
  dnnl::primitive_attr with_activation() const {
    dnnl::primitive_attr attributes;
    const Index next = layer_ + 1;
    if (next == static_cast<Index>(network_.layers.size())) return attributes;
    const auto kind = network_.layers[next].at("kind").get<std::string>();
    dnnl::post_ops after;
    if (kind == "relu") after.append_eltwise(1.0F, dnnl::algorithm::eltwise_relu, 0.0F, 0.0F);
    if (kind == "tanh") after.append_eltwise(1.0F, dnnl::algorithm::eltwise_tanh, 0.0F, 0.0F);
    attributes.set_post_ops(after);
    return attributes;
  }

  /// What `from` holds, in the layout `to`; `once` now, else in every call.
  memory reordered(memory from, const memory::desc& to, bool once) {
    if (from.get_desc() == to) return from;
    memory result(to, engine_);
    const dnnl::reorder reorder(from, result);
    if (once) {
      dnnl::stream now(engine_);
      reorder.execute(now, from, result);
      now.wait();
    } else {
      steps_.push_back({reorder, {{DNNL_ARG_FROM, from}, {DNNL_ARG_TO, result}}});
    }
    return result;
  }

  /// Stored weights in the layout that a primitive wants.
  memory weights(const char* name, const Dims& dims, Tag tag, const memory::desc& wanted) {
    auto* values = const_cast<float*>(network_.values(layer_, name));
    const memory given(described(dims, tag), engine_, values);
    memory copy(described(dims, tag), engine_);
    std::memcpy(copy.get_data_handle(), values, given.get_desc().get_size());
    return reordered(copy, wanted, true);
  }

  void add_convolution(const Json& layer) {
    const auto& shape = network_.tensor(layer_, "weight").shape;  // (h, w, C, filters)
    const Index h = shape[0], w = shape[1];
    Dims before{0, 0}, after{0, 0};
    if (layer.value("padding", "same") == "same") {
      before = {(h - 1) / 2, (w - 1) / 2};
      after = {h - 1 - before[0], w - 1 - before[1]};
    }
    const Dims to{batch_, shape[3], sample_[1] + before[0] + after[0] - h + 1,
                  sample_[2] + before[1] + after[1] - w + 1};
    const Dims kernel{shape[3], shape[2], h, w};
    using Convolution = dnnl::convolution_forward;
    const Convolution::primitive_desc chosen(
        Convolution::desc(dnnl::prop_kind::forward_inference, dnnl::algorithm::convolution_direct,
                          described(flow_.get_desc().dims(), Tag::any), described(kernel, Tag::any),
                          described({shape[3]}, Tag::a), described(to, Tag::any), {1, 1}, before,
                          after),
        with_activation(), engine_);
    add(Convolution(chosen), chosen, kernel, Tag::cdba);
    // Tag::cdba of (filters, C, h, w) is our (h, w, C, filters).
    sample_ = {to[1], to[2], to[3]};
  }

  void add_linear() {
    const auto& shape = network_.tensor(layer_, "weight").shape;
    Dims kernel = flow_.get_desc().dims();
    kernel[0] = shape[0];
    using Product = dnnl::inner_product_forward;
    const Product::primitive_desc chosen(
        Product::desc(dnnl::prop_kind::forward_inference,
                      described(flow_.get_desc().dims(), Tag::any), described(kernel, Tag::any),
                      described({shape[0]}, Tag::a), described({batch_, shape[0]}, Tag::any)),
        with_activation(), engine_);
    add(Product(chosen), chosen, kernel, kernel.size() == 4 ? Tag::acdb : Tag::ab);
  }

  template <class Chosen>
  void add(const dnnl::primitive& primitive, const Chosen& chosen, const Dims& kernel, Tag tag) {
    const memory from = reordered(flow_, chosen.src_desc(), false);
    flow_ = memory(chosen.dst_desc(), engine_);
    outputs_ = flow_.get_desc().dims()[1];
    steps_.push_back({primitive,
                      {{DNNL_ARG_SRC, from},
                       {DNNL_ARG_WEIGHTS, weights("weight", kernel, tag, chosen.weights_desc())},
                       {DNNL_ARG_BIAS, weights("bias", {kernel[0]}, Tag::a, chosen.bias_desc())},
                       {DNNL_ARG_DST, flow_}}});
  }

  /// The gates i, f, candidate, o lie as ours do; of the outputs the newest step goes on.
  void add_lstm() {
    const Index inputs = network_.tensor(layer_, "input_weight").shape[0];
    const Index units = network_.tensor(layer_, "recurrent_weight").shape[0];
    const Index steps = network_.input[0];
    const Dims input{1, 1, inputs, 4, units}, recurrent{1, 1, units, 4, units};
    using Lstm = dnnl::lstm_forward;
    const memory::desc none, carried = described({1, 1, batch_, units}, Tag::ldnc);
    const memory::desc& iter = network_.carries ? carried : none;
    const Lstm::primitive_desc chosen(
        Lstm::desc(
            dnnl::prop_kind::forward_inference, dnnl::rnn_direction::unidirectional_left2right,
            described({steps, batch_, inputs}, Tag::tnc), iter, iter, described(input, Tag::any),
            described(recurrent, Tag::any), described({1, 1, 4, units}, Tag::ldgo),
            described({steps, batch_, units}, Tag::tnc), iter, iter),
        engine_);
    const memory from = reordered(flow_, chosen.src_layer_desc(), false);
    memory all(chosen.dst_layer_desc(), engine_);
    steps_.push_back(
        {Lstm(chosen),
         {{DNNL_ARG_SRC_LAYER, from},
          {DNNL_ARG_WEIGHTS_LAYER,
           weights("input_weight", input, Tag::ldigo, chosen.weights_layer_desc())},
          {DNNL_ARG_WEIGHTS_ITER,
           weights("recurrent_weight", recurrent, Tag::ldigo, chosen.weights_iter_desc())},
          {DNNL_ARG_BIAS, weights("bias", {1, 1, 4, units}, Tag::ldgo, chosen.bias_desc())},
          {DNNL_ARG_DST_LAYER, all}}});
    if (network_.carries) {
      carry(carried, DNNL_ARG_SRC_ITER, DNNL_ARG_DST_ITER);
      carry(carried, DNNL_ARG_SRC_ITER_C, DNNL_ARG_DST_ITER_C);
    }
    kept_.push_back(all);
    auto* newest = static_cast<float*>(all.get_data_handle()) + (steps - 1) * batch_ * units;
    flow_ = memory(described({batch_, units}, Tag::nc), engine_, newest);
    outputs_ = units;
  }

  /// A state that the newest step reads as `from` and writes as `to`.
  void carry(const memory::desc& desc, int from, int to) {
    const State state{memory(desc, engine_), memory(desc, engine_)};
    steps_.back().arguments.insert({{from, state.before}, {to, state.after}});
    states_.push_back(state);
  }

  void finish() {
    if (flow_.get_desc().dims().size() == 2) {
      flow_ = reordered(flow_, described(flow_.get_desc().dims(), Tag::nc), false);
    }
  }

  const ExportedNetwork& network_;
  Index batch_, outputs_, layer_ = 0;
  Dims sample_;  // (C, H, W) of the image where there is one
  dnnl::engine engine_{dnnl::engine::kind::cpu, 0};
  dnnl::stream stream_{engine_};
  memory::desc given_;
  memory input_, flow_;
  std::vector<memory> kept_;
  std::vector<State> states_;
  std::vector<Step> steps_;
};

std::string version() {
  const dnnl_version_t* v = dnnl_version();
  return std::to_string(v->major) + "." + std::to_string(v->minor) + "." + std::to_string(v->patch);
}

}  // namespace
}  // namespace dcnn::peers

int main() {
  using namespace dcnn;
  return peers::serve({.name = "oneDNN",
                       .version = peers::version(),
                       .load = [](const peers::ExportedNetwork& network, Index batch, int threads) {
                         omp_set_num_threads(threads);
                         return std::make_unique<peers::OneDnnRunner>(network, batch);
                       }});
}
