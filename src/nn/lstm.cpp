// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "dcnn/nn/layer.h"
#include "nn/init.h"
#include "nn/kernels/channels.h"
#include "nn/lstm_plan.h"
#include "nn/lstm_steps.h"
#include "nn/pieces.h"

namespace dcnn {
namespace {

/// Long short-term memory: (N, T, F) in, h of the newest step (N, H) out, or of all steps (N, T,
/// H). The state is zero before the first step. input_weight (F, 4H), recurrent_weight (H, 4H), one
/// bias (4H); the columns of all three are the gates i | f | g | o, g being the candidate.
class Lstm final : public Layer {
 public:
  struct Weights {
    Tensor input, recurrent, bias;
  };
  Lstm(const LstmShape& shape, Weights weights) : shape_(shape), weights_(std::move(weights)) {}

  bool is_divisible() const override { return false; }  // on the way back pieces share memory
  Tensor forward(const Tensor& x, Pass&) const override {
    const LstmShape& s = shape_;
    const Weights& w = weights_;
    const bool keep = recording({x, w.input, w.recurrent, w.bias});
    const Index kept = LstmTrace::kept_steps(s, keep), cells = LstmTrace::size(s, kept);
    const Tensor trace = Tensor::uninitialised({keep ? x.dim(0) : 0, cells});
    Tensor y = Tensor::uninitialised(s.sequence ? Shape{x.dim(0), s.steps, s.units}
                                                : Shape{x.dim(0), s.units});
    const Panels both = joined_weights(s, w, s.steps > 1);
    for_each_part(x.dim(0), [&](Index, Index begin, Index samples) {
      const Tensor own = Tensor::uninitialised({keep ? 0 : samples, cells});
      const LstmTrace part(s, samples, kept, keep ? trace.data() + begin * cells : own.data());
      run_lstm(part, both, w.bias.data(), x.data() + begin * s.steps * s.inputs,
               y.data() + begin * s.outputs());
    });
    return record(y, {x, w.input, w.recurrent, w.bias}, [s, x, w, trace](const Tensor& out) {
      backward(s, x, w, trace, out.gradient_data());
    });
  }

  std::unique_ptr<PlanStep> plan(const Shape&, PlanStep*) const override {
    return make_lstm_step(shape_, joined_weights(shape_, weights_, true), weights_.bias);
  }

  std::vector<NamedTensor> state() const override {
    return {{"input_weight", weights_.input, NamedTensor::Role::kWeight},
            {"recurrent_weight", weights_.recurrent, NamedTensor::Role::kWeight},
            {"bias", weights_.bias, NamedTensor::Role::kBias}};
  }

 private:
  /// Both weights, one above the other, as factors of x_t | h_(t-1); of one step alone from no
  /// state those of h are not needed.
  static Panels joined_weights(const LstmShape& s, const Weights& w, bool recurs) {
    Panels both(s.joined(), s.gates());
    both.set(0, s.inputs, w.input.data(), s.gates(), 1);
    if (recurs) both.set(s.inputs, s.units, w.recurrent.data(), s.gates(), 1);
    return both;
  }

  /// Sums of the weights' gradients over some pieces: a fixed few, as each is as large as the
  /// weights.
  struct Sums {
    PieceSums input, recurrent;
    Sums(const LstmShape& s, Index groups, const Weights& w)
        : input(groups, w.input.size()), recurrent(s.steps > 1 ? groups : 0, w.recurrent.size()) {}
    void clear(Index group) {
      std::fill_n(input.of(group), input.size(), Real(0));
      if (group < recurrent.pieces()) std::fill_n(recurrent.of(group), recurrent.size(), Real(0));
    }
  };

  static void backward(const LstmShape& s, const Tensor& x, const Weights& w, const Tensor& memory,
                       const Real* dy) {
    const Index pieces = piece_count(x.dim(0)), groups = std::min<Index>(pieces, 4);
    const Index kept = LstmTrace::kept_steps(s, true);
    Sums sums(s, groups, w);
    PieceSums dbias(x.dim(0), s.gates());
    Panels recurrent(s.gates(), s.units), input(s.gates(), s.inputs);
    if (s.steps > 1) recurrent.set(0, s.gates(), w.recurrent.data(), 1, s.gates());
    const Tensor::GradientSlot dx = x.wants_gradient() ? x.gradient_slot() : Tensor::GradientSlot{};
    if (dx.data) input.set(0, s.gates(), w.input.data(), 1, s.gates());
    for_each_piece(groups, [&](Index group) {
      sums.clear(group);
      for (Index k = piece_begin(pieces, groups, group); k < piece_begin(pieces, groups, group + 1);
           ++k) {
        const Index begin = piece_begin(x.dim(0), pieces, k);
        const LstmTrace trace(s, piece_begin(x.dim(0), pieces, k + 1) - begin, kept,
                              memory.data() + begin * LstmTrace::size(s, kept));
        run_lstm_back(trace, recurrent, dy + begin * s.outputs());
        add_weight_gradients(trace, sums.input.of(group),
                             s.steps > 1 ? sums.recurrent.of(group) : nullptr);
        channel_sums(trace.gates, s.steps * trace.samples, s.gates(), dbias.of(k));
        if (dx.data) {
          put_input_gradient(trace, input, {dx.data + begin * s.steps * s.inputs, dx.add});
        }
      }
    });
    sum_pieces(sums.input, w.input);
    if (s.steps > 1) {
      sum_pieces(sums.recurrent, w.recurrent);
    } else {
      w.recurrent.gradient_data();  // zeros, where nothing was before
    }
    sum_pieces(dbias, w.bias);
  }

  LstmShape shape_;
  Weights weights_;
};

/// `init`: glorot (the recurrent weight has orthonormal rows, Saxe et al. 2014) or narrow. The
/// forget gate's bias begins at 1 (Jozefowicz et al. 2015), the others' at 0.
Lstm::Weights initial_weights(Options& options, const LstmShape& s, Rng& rng) {
  Lstm::Weights w;
  w.input = initial_weight(options, {s.inputs, s.gates()}, s.inputs, s.gates(), rng);
  w.recurrent = initial_weight(options, {s.units, s.gates()}, s.units, s.gates(), rng);
  if (options.get<std::string>("init", "glorot") == "glorot") orthonormal_rows(w.recurrent);
  w.bias = Tensor({s.gates()}, true);
  std::fill_n(w.bias.data() + s.units, s.units, Real(1));
  return w;
}

LayerPtr make_lstm(Options& options, const Shape& input, Rng& rng) {
  constexpr Index kMost = 512;  // beyond, finding an orthonormal start takes seconds
  const Index units = read_units(options, "units");
  if (units > kMost) options.reject("units", "must be at most ", kMost, ", not ", units);
  require(input.size() == 2, Exit::kUsage, "lstm: input ", to_string(input),
          " is not a sequence (steps, features); use a window of rows as input");
  const LstmShape shape{input[0], input[1], units, options.get("sequence", false)};
  return std::make_unique<Lstm>(shape, initial_weights(options, shape, rng));
}

}  // namespace

extern constinit const LayerKind lstm{
    .name = "lstm", .example = R"({"units": 5})", .example_input = {6, 4, 3}, .make = make_lstm};

}  // namespace dcnn
