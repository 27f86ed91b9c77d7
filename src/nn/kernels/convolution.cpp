// SPDX-License-Identifier: Apache-2.0
#include "nn/kernels/convolution.h"

#include <algorithm>
#include <vector>

#include "nn/kernels/taps.h"
#include "nn/kernels/tile.h"

namespace dcnn {
namespace {

/// Products over a block of output positions, the longer side inside.
struct Block {
  std::vector<Run> runs;
  Index a_step, b_step;
};

void block_runs(const ConvShape& s, Index samples, Index rows, Index columns, Block& block) {
  const bool down = rows >= columns;
  const Index a_down = s.in_w * s.in_c, b_down = s.out_w * s.out_c;
  const Index outer = down ? columns : rows;
  block.a_step = down ? a_down : s.in_c;
  block.b_step = down ? b_down : s.out_c;
  block.runs.clear();
  for (Index n = 0; n < samples; ++n) {
    for (Index i = 0; i < outer; ++i) {
      block.runs.push_back({n * s.in_size() + i * (down ? s.in_c : a_down),
                            n * s.out_size() + i * (down ? s.out_c : b_down),
                            down ? rows : columns});
    }
  }
}

}  // namespace

ConvShape transposed(const ConvShape& s) {
  return {s.out_h,
          s.out_w,
          s.out_c,
          s.in_h,
          s.in_w,
          s.in_c,
          s.window_h,
          s.window_w,
          s.window_h - 1 - s.before_h,
          s.window_w - 1 - s.before_w};
}

void flip_weights(const ConvShape& s, const Real* weights, Real* flipped) {
  const Index taps = s.window_h * s.window_w;
  for (Index tap = 0; tap < taps; ++tap) {
    const Real* from = weights + (taps - 1 - tap) * s.in_c * s.out_c;
    Real* to = flipped + tap * s.in_c * s.out_c;
    for (Index o = 0; o < s.out_c; ++o) {
      for (Index i = 0; i < s.in_c; ++i) to[o * s.in_c + i] = from[i * s.out_c + o];
    }
  }
}

void convolve(const ConvShape& s, Index samples, const Real* x, const Real* weights,
              const Real* bias, Real* out, bool add) {
  std::vector<Run> runs;
  for (Index row = 0; row < s.out_h; ++row) {
    for (Index column = 0; column < s.out_w; ++column) {
      position_runs(s, row, column, runs);
      Real* to = out + (row * s.out_w + column) * s.out_c;
      tile_product({.a = x,
                    .a_row = s.in_size(),
                    .a_step = 1,
                    .b = weights,
                    .b_step = s.out_c,
                    .runs = runs,
                    .out = to,
                    .out_row = s.out_size(),
                    .start = add ? to : bias,
                    .start_row = add ? s.out_size() : 0,
                    .rows = samples,
                    .columns = s.out_c});
    }
  }
}

void weight_gradient(const ConvShape& s, Index samples, const Real* x, const Real* out_gradient,
                     Real* gradient) {
  std::fill_n(gradient, s.weight_size(), Real(0));
  Block block;
  for (Index begin = 0, end; begin < s.out_w; begin = end) {
    const Taps taps = column_taps(s, begin);
    for (end = begin + 1; end < s.out_w && column_taps(s, end) == taps;) ++end;
    for (Index tap = 0; tap < s.window_h; ++tap) {
      const Index top = std::max<Index>(0, s.before_h - tap);
      const Index bottom = std::min(s.out_h, s.in_h + s.before_h - tap);
      if (top >= bottom) continue;
      block_runs(s, samples, bottom - top, end - begin, block);
      const Index in_row = top - s.before_h + tap, in_column = begin - s.before_w + taps.begin;
      Real* to = gradient + (tap * s.window_w + taps.begin) * s.in_c * s.out_c;
      tile_product({.a = x + (in_row * s.in_w + in_column) * s.in_c,
                    .a_row = 1,
                    .a_step = block.a_step,
                    .b = out_gradient + (top * s.out_w + begin) * s.out_c,
                    .b_step = block.b_step,
                    .runs = block.runs,
                    .out = to,
                    .out_row = s.out_c,
                    .start = to,
                    .start_row = s.out_c,
                    .rows = (taps.end - taps.begin) * s.in_c,
                    .columns = s.out_c});
    }
  }
}

}  // namespace dcnn
