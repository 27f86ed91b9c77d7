// SPDX-License-Identifier: Apache-2.0
// Work on a batch, piece by piece: what every layer shares.
#pragma once

#include <algorithm>

#include "dcnn/core/ranks.h"
#include "dcnn/core/tensor.h"
#include "nn/kernels/elementwise.h"

namespace dcnn {

/// Calls work(piece, first sample, number of samples) for the fixed pieces of a batch of n, those
/// of this process where several train together.
template <class Work>
void for_each_part(Index n, const Work& work) {
  const Index pieces = piece_count(n);
  const PieceRange own = own_pieces(pieces);
  for_each_piece(own.end - own.begin, [&](Index i) {
    const Index k = own.begin + i, begin = piece_begin(n, pieces, k);
    work(k, begin, piece_begin(n, pieces, k + 1) - begin);
  });
}

/// Calls work(first value, number of values) for the values of each piece of the batch x (N, …).
template <class Work>
void for_each_range(const Tensor& x, const Work& work) {
  const Index per_sample = x.size() / std::max<Index>(x.dim(0), 1);
  for_each_part(x.dim(0), [&](Index, Index begin, Index samples) {
    work(begin * per_sample, samples * per_sample);
  });
}

/// An array per piece, which work on it writes, to be added up in the order of the pieces once it
/// is shared: the same sum for any number of threads and processes.
class PieceSums {
 public:
  PieceSums(Index n, Index size)
      : pieces_(piece_count(n)), size_(size), values_(Tensor::uninitialised({pieces_, size})) {}
  Real* of(Index piece) { return values_.data() + piece * size_; }
  void share() {
    const auto bytes = static_cast<Index>(sizeof(Real));
    share_pieces(values_.data(), pieces_, [&](Index k) { return k * size_ * bytes; });
  }
  const Real* data() const { return values_.data(); }
  Index pieces() const { return pieces_; }
  Index size() const { return size_; }

 private:
  Index pieces_, size_;
  Tensor values_;
};

/// Gives the sum to the gradient of `of`.
inline void sum_pieces(PieceSums& sums, const Tensor& of) {
  if (!of.wants_gradient()) return;
  sums.share();
  sum_arrays(sums.data(), sums.pieces(), sums.size(), of.gradient_slot());
}

}  // namespace dcnn
