#include <algorithm>

#include "dcnn/nn/layer.h"
#include "nn/init.h"
#include "nn/kernels/channels.h"
#include "nn/kernels/lstm_cell.h"
#include "nn/kernels/panels.h"
#include "nn/kernels/tile.h"
#include "nn/pieces.h"

namespace dcnn {
namespace {

struct LstmShape {
  Index steps, inputs, units;
  bool sequence;  // h of every step, not of the newest alone

  Index joined() const { return inputs + units; }
  Index gates() const { return 4 * units; }
};

/// What the steps of `samples` samples leave for the way back. Arrays are (steps, samples, width):
/// a step is one matrix, and so are all steps together.
struct Trace {
  LstmShape shape;
  Index samples;
  Real* joined;  // x_t | h_(t-1); one step more than there are: the last one holds h alone
  Real *gates, *c, *tanh_c;

  static Index size(const LstmShape& s) {
    return (s.steps + 1) * s.joined() + s.steps * (s.gates() + 2 * s.units);
  }
  Trace(const LstmShape& s, Index n, Real* memory)
      : shape(s),
        samples(n),
        joined(memory),
        gates(joined + (s.steps + 1) * n * s.joined()),
        c(gates + s.steps * n * s.gates()),
        tanh_c(c + s.steps * n * s.units) {}

  Real* joined_at(Index t) const { return joined + t * samples * shape.joined(); }
  Real* gates_at(Index t) const { return gates + t * samples * shape.gates(); }
  Real* tanh_c_at(Index t) const { return tanh_c + t * samples * shape.units; }
  Real* c_at(Index t) const { return t < 0 ? nullptr : c + t * samples * shape.units; }
};

/// Long short-term memory: (N, T, F) in, h of the newest step (N, H) out, or of all steps (N, T,
/// H). The state is zero before the first step. input_weight (F, 4H), recurrent_weight (H, 4H), one
/// bias (4H); the columns of all three are the gates i | f | g | o, g being the candidate.
class Lstm final : public Layer {
 public:
  struct Weights {
    Tensor input, recurrent, bias;
  };
  Lstm(const LstmShape& shape, Weights weights) : shape_(shape), weights_(std::move(weights)) {}

  Tensor forward(const Tensor& x, Pass&) const override {
    const LstmShape& s = shape_;
    const Weights& w = weights_;
    const bool keep = recording({x, w.input, w.recurrent, w.bias});
    const Tensor trace = Tensor::uninitialised({keep ? x.dim(0) : 0, Trace::size(s)});
    Tensor y = Tensor::uninitialised(s.sequence ? Shape{x.dim(0), s.steps, s.units}
                                                : Shape{x.dim(0), s.units});
    const Panels both = joined_weights(s, w);
    for_each_part(x.dim(0), [&](Index, Index begin, Index samples) {
      const Tensor own = Tensor::uninitialised({keep ? 0 : samples, Trace::size(s)});
      const Trace part(s, samples, keep ? trace.data() + begin * Trace::size(s) : own.data());
      run(part, both, w.bias.data(), x.data() + begin * s.steps * s.inputs);
      copy_out(part, y.data() + begin * (y.size() / std::max<Index>(x.dim(0), 1)));
    });
    return record(y, {x, w.input, w.recurrent, w.bias}, [s, x, w, trace](const Tensor& out) {
      backward(s, x, w, trace, out.gradient_data());
    });
  }

  std::vector<NamedTensor> state() const override {
    return {{"input_weight", weights_.input, NamedTensor::Role::kWeight},
            {"recurrent_weight", weights_.recurrent, NamedTensor::Role::kWeight},
            {"bias", weights_.bias, NamedTensor::Role::kBias}};
  }

 private:
  /// Both weights, one above the other, as factors of x_t | h_(t-1).
  static Panels joined_weights(const LstmShape& s, const Weights& w) {
    Panels both(s.joined(), s.gates());
    both.set(0, s.inputs, w.input.data(), s.gates(), 1);
    if (s.steps > 1) both.set(s.inputs, s.units, w.recurrent.data(), s.gates(), 1);
    return both;
  }

  static void run(const Trace& trace, const Panels& weights, const Real* bias, const Real* x) {
    const LstmShape& s = trace.shape;
    for (Index t = 0; t < s.steps; ++t) {
      Real* joined = trace.joined_at(t);
      for (Index n = 0; n < trace.samples; ++n) {
        std::copy_n(x + (n * s.steps + t) * s.inputs, s.inputs, joined + n * s.joined());
      }
      weights.multiply({.a = joined,
                        .a_row = s.joined(),
                        .rows = trace.samples,
                        .depth = t > 0 ? s.joined() : s.inputs,
                        .out = trace.gates_at(t),
                        .out_row = s.gates(),
                        .start = bias,
                        .start_row = 0});
      lstm_cell({.rows = trace.samples,
                 .units = s.units,
                 .gates = trace.gates_at(t),
                 .c_before = trace.c_at(t - 1),
                 .c = trace.c_at(t),
                 .tanh_c = trace.tanh_c_at(t),
                 .h = trace.joined_at(t + 1) + s.inputs,
                 .h_row = s.joined()});
    }
  }

  static void copy_out(const Trace& trace, Real* y) {
    const LstmShape& s = trace.shape;
    for (Index n = 0; n < trace.samples; ++n) {
      for (Index t = s.sequence ? 1 : s.steps; t <= s.steps; ++t, y += s.units) {
        std::copy_n(trace.joined_at(t) + n * s.joined() + s.inputs, s.units, y);
      }
    }
  }

  /// Sums of the weights' gradients over some pieces: a fixed few, as each is as large as the
  /// weights.
  struct Sums {
    PieceSums input, recurrent;
    Sums(Index groups, const Weights& w)
        : input(groups, w.input.size()), recurrent(groups, w.recurrent.size()) {}
  };

  static void backward(const LstmShape& s, const Tensor& x, const Weights& w, const Tensor& memory,
                       const Real* dy) {
    const Index pieces = piece_count(x.dim(0)), groups = std::min<Index>(pieces, 4);
    Sums sums(groups, w);
    PieceSums dbias(x.dim(0), s.gates());
    Panels recurrent(s.gates(), s.units), input(s.gates(), s.inputs);
    recurrent.set(0, s.gates(), w.recurrent.data(), 1, s.gates());
    const Tensor::GradientSlot dx = x.wants_gradient() ? x.gradient_slot() : Tensor::GradientSlot{};
    if (dx.data) input.set(0, s.gates(), w.input.data(), 1, s.gates());
    for_each_piece(groups, [&](Index group) {
      for (Index k = piece_begin(pieces, groups, group); k < piece_begin(pieces, groups, group + 1);
           ++k) {
        const Index begin = piece_begin(x.dim(0), pieces, k);
        const Trace trace(s, piece_begin(x.dim(0), pieces, k + 1) - begin,
                          memory.data() + begin * Trace::size(s));
        run_back(trace, recurrent, dy + begin * s.units * (s.sequence ? s.steps : 1));
        weight_products(trace, sums.input.of(group), sums.recurrent.of(group));
        channel_sums(trace.gates, s.steps * trace.samples, s.gates(), dbias.of(k));
        if (dx.data) {
          input_gradient(trace, input, {dx.data + begin * s.steps * s.inputs, dx.add});
        }
      }
    });
    sum_pieces(sums.input, w.input);
    sum_pieces(sums.recurrent, w.recurrent);
    sum_pieces(dbias, w.bias);
  }

  /// Back through time (Werbos 1990): turns the gates of every step into the gradients of their
  /// arguments.
  static void run_back(const Trace& trace, const Panels& recurrent, const Real* dy) {
    const LstmShape& s = trace.shape;
    const Index width = s.sequence ? s.steps * s.units : s.units;  // from sample to sample of dy
    Tensor dh({trace.samples, s.units}), dc({trace.samples, s.units});
    for (Index t = s.steps - 1; t >= 0; --t) {
      if (s.sequence || t == s.steps - 1) {
        const Real* from = dy + (s.sequence ? t * s.units : 0);
        for (Index n = 0; n < trace.samples; ++n) {
          for (Index k = 0; k < s.units; ++k) dh.data()[n * s.units + k] += from[n * width + k];
        }
      }
      lstm_cell_gradient({.rows = trace.samples,
                          .units = s.units,
                          .gates = trace.gates_at(t),
                          .c_before = trace.c_at(t - 1),
                          .tanh_c = trace.tanh_c_at(t),
                          .dh = dh.data(),
                          .dc = dc.data()});
      if (t == 0) return;
      recurrent.multiply({.a = trace.gates_at(t),
                          .a_row = s.gates(),
                          .rows = trace.samples,
                          .depth = s.gates(),
                          .out = dh.data(),
                          .out_row = s.units,
                          .start = nullptr,
                          .start_row = 0});
    }
  }

  /// Adds xᵀ·(gradients of the gates' arguments) over all steps at once, and h the same way over
  /// all but the first.
  static void weight_products(const Trace& trace, Real* input, Real* recurrent) {
    const LstmShape& s = trace.shape;
    const auto add = [&](Index first_step, const Real* a, Index rows, Real* to) {
      const Run run{0, 0, (s.steps - first_step) * trace.samples};
      tile_product({.a = a,
                    .a_row = 1,
                    .a_step = s.joined(),
                    .b = trace.gates_at(first_step),
                    .b_step = s.gates(),
                    .runs = {&run, 1},
                    .out = to,
                    .out_row = s.gates(),
                    .start = to,
                    .start_row = s.gates(),
                    .rows = rows,
                    .columns = s.gates()});
    };
    add(0, trace.joined, s.inputs, input);
    if (s.steps > 1) add(1, trace.joined_at(1) + s.inputs, s.units, recurrent);
  }

  static void input_gradient(const Trace& trace, const Panels& input, Tensor::GradientSlot dx) {
    const LstmShape& s = trace.shape;
    for (Index t = 0; t < s.steps; ++t) {
      Real* to = dx.data + t * s.inputs;
      input.multiply({.a = trace.gates_at(t),
                      .a_row = s.gates(),
                      .rows = trace.samples,
                      .depth = s.gates(),
                      .out = to,
                      .out_row = s.steps * s.inputs,
                      .start = dx.add ? to : nullptr,
                      .start_row = s.steps * s.inputs});
    }
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
