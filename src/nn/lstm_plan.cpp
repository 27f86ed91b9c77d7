// SPDX-License-Identifier: Apache-2.0
#include "nn/lstm_plan.h"

#include <algorithm>

#include "nn/kernels/lstm_online.h"

namespace dcnn {
namespace {

/// A window of T rows takes T products with all weights, which stream from the second cache each
/// time; only those with the rows themselves are made together. Of a window that slides, all T
/// windows in which the newest row takes part are therefore held and advanced by it together: as
/// many products, but the weights are read once.
class LstmStep final : public PlanStep {
 public:
  LstmStep(const LstmShape& shape, Panels weights, const Tensor& bias)
      : shape_(shape),
        row_(shape.units + LstmOnline::kSlack),
        weights_(std::move(weights)),
        bias_({weights_.padded_columns()}),
        input_({weights_.padded_columns()}),
        gates_({kTogether * weights_.padded_columns() + LstmOnline::kSlack}),
        joined_({shape.inputs + row_}),
        c_({row_}),
        many_joined_({kTogether, shape.inputs + row_}),
        many_c_({kTogether, shape.inputs + row_}),
        window_h_({slides() ? shape.steps : 0, row_}),
        window_c_({slides() ? shape.steps : 0, row_}) {
    std::ranges::copy(bias.values(), bias_.data());
  }

  void run(const Real* x, Real* y) noexcept override {
    begin();
    for (Index t = 0; t < shape_.steps; ++t) {
      const Index place = t % kTogether, left = std::min(kTogether, shape_.steps - t);
      if (place == 0) add_inputs(x + t * shape_.inputs, left, gates_.data());
      advance(gates_.data() + place * gates_row(), t > 0);
      if (shape_.sequence) put_h(y + t * shape_.units);
    }
    if (!shape_.sequence) put_h(y);
  }

  void carry(const Real* x, bool begins, Real* y) noexcept override {
    if (begins) begin();
    std::copy_n(x, shape_.inputs, joined_.data());
    multiply({joined_.data(), 0, 1, 0, begins ? shape_.inputs : shape_.joined()}, bias_.data(), 0,
             gates_.data());
    apply_cell(gates_.data());
    put_h(y);
  }

  Index together() const override { return kTogether; }
  bool run_many(const Real* x, Index n, Real* y) noexcept override {
    if (n == 1) return false;
    const Index units = shape_.units, row = many_joined_.dim(1);
    Real* h = many_joined_.data() + shape_.inputs;
    std::fill_n(many_c_.data(), n * row, Real(0));
    for (Index t = 0; t < shape_.steps; ++t) {
      advance_many(x + t * shape_.inputs, n, t > 0);
      if (t + 1 < shape_.steps && !shape_.sequence) continue;
      for (Index i = 0; i < n; ++i) {
        std::copy_n(h + i * row, units,
                    y + i * shape_.outputs() + (shape_.sequence ? t * units : 0));
      }
    }
    return true;
  }

  void slide(const Real* x, bool begins, Real* y) noexcept override {
    if (!slides()) return run(x, y);
    if (begins) return begin_windows(x, y);
    advance_windows(x + (shape_.steps - 1) * shape_.inputs);
    std::copy_n(window_h_.data() + oldest_ * row_, shape_.units, y);
    clear(oldest_);
    oldest_ = oldest_ + 1 == shape_.steps ? 0 : oldest_ + 1;
  }

 private:
  /// As many windows or samples in one product as fill the tile's registers twice.
  static constexpr Index kTogether = 26;

  bool slides() const { return shape_.steps > 1 && !shape_.sequence; }
  Index gates_row() const { return weights_.padded_columns(); }
  Real* h() { return joined_.data() + shape_.inputs; }
  void put_h(Real* y) { std::copy_n(h(), shape_.units, y); }
  void begin() { std::fill_n(c_.data(), shape_.units, Real(0)); }

  /// Rows of a left factor and the rows of the weights that they meet.
  struct Factor {
    const Real* a;
    Index a_row, rows, first, depth;
  };
  /// gates = start + the products.
  void multiply(const Factor& f, const Real* start, Index start_row, Real* gates) {
    weights_.multiply({.a = f.a,
                       .a_row = f.a_row,
                       .rows = f.rows,
                       .depth = f.depth,
                       .out = gates,
                       .out_row = gates_row(),
                       .start = start,
                       .start_row = start_row,
                       .first = f.first,
                       .padded = true});
  }
  /// gates = bias + the products of rows of x alone.
  void add_inputs(const Real* x, Index rows, Real* gates) {
    multiply({x, shape_.inputs, rows, 0, shape_.inputs}, bias_.data(), 0, gates);
  }

  /// One window by the row of which `gates` has the products.
  void advance(Real* gates, bool recurs) {
    if (recurs) multiply({h(), 0, 1, shape_.inputs, shape_.units}, gates, 0, gates);
    apply_cell(gates);
  }
  void apply_cell(const Real* gates) {
    lstm_online({1, shape_.units, gates, gates_row(), c_.data(), h(), row_});
  }

  /// n samples by the row x of each, the weights read once for all.
  void advance_many(const Real* x, Index n, bool recurs) {
    const Index inputs = shape_.inputs, row = many_joined_.dim(1);
    Real* joined = many_joined_.data();
    for (Index i = 0; i < n; ++i) {
      std::copy_n(x + i * shape_.steps * inputs, inputs, joined + i * row);
    }
    multiply({joined, row, n, 0, recurs ? shape_.joined() : inputs}, bias_.data(), 0,
             gates_.data());
    lstm_online(
        {n, shape_.units, gates_.data(), gates_row(), many_c_.data(), joined + inputs, row});
  }

  /// All rows of x are the same: a younger window has seen what an older one had seen earlier.
  void begin_windows(const Real* x, Real* y) {
    begin();
    oldest_ = 0;
    clear(shape_.steps - 1);
    for (Index t = 0; t < shape_.steps; ++t) {
      add_inputs(x, 1, gates_.data());
      advance(gates_.data(), t > 0);
      const Index window = shape_.steps - 2 - t;
      if (window < 0) continue;
      put_h(window_h_.data() + window * row_);
      std::copy_n(c_.data(), shape_.units, window_c_.data() + window * row_);
    }
    put_h(y);
  }

  /// A window that has seen nothing yet.
  void clear(Index window) {
    std::fill_n(window_h_.data() + window * row_, shape_.units, Real(0));
    std::fill_n(window_c_.data() + window * row_, shape_.units, Real(0));
  }

  void advance_windows(const Real* x) {
    add_inputs(x, 1, input_.data());
    const Index pieces = (shape_.steps + kTogether - 1) / kTogether;
    for (Index k = 0; k < pieces; ++k) {
      const Index begin = shape_.steps * k / pieces;
      const Index count = shape_.steps * (k + 1) / pieces - begin;
      Real *h = window_h_.data() + begin * row_, *c = window_c_.data() + begin * row_;
      multiply({h, row_, count, shape_.inputs, shape_.units}, input_.data(), 0, gates_.data());
      lstm_online({count, shape_.units, gates_.data(), gates_row(), c, h, row_});
    }
  }

  LstmShape shape_;
  Index row_;  // of h and c
  Panels weights_;
  Tensor bias_, input_, gates_;  // bias, its sum with the newest row's products; (rows, gates)
  Tensor joined_, c_;            // x_t | h_(t-1) and c of one window from its begin
  Tensor many_joined_, many_c_;  // the same of many, at equal steps
  Tensor window_h_, window_c_;   // (T, row_) of the windows that slide
  Index oldest_ = 0;             // the window that the next row completes
};

}  // namespace

std::unique_ptr<PlanStep> make_lstm_step(const LstmShape& shape, Panels weights,
                                         const Tensor& bias) {
  return std::make_unique<LstmStep>(shape, std::move(weights), bias);
}

}  // namespace dcnn
