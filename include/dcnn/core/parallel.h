// SPDX-License-Identifier: Apache-2.0
// Work in fixed pieces: the pieces, and so every sum over them, do not depend on the threads.
#pragma once

#include <cstdint>
#include <functional>

namespace dcnn {

using Index = std::int64_t;

/// How many pieces a batch of n samples is cut into: a multiple of four (so that 1, 2 or 4 threads
/// have equal work), none larger than 13 samples (one register tile of the AVX-512 kernel). 1 for n
/// < 4.
Index piece_count(Index n);

/// Where piece k of `pieces` begins; piece k ends where k + 1 begins.
inline Index piece_begin(Index n, Index pieces, Index k) { return n * k / pieces; }

/// Calls work(k) for k in [0, count) on the OpenMP threads; which thread takes which k is fixed.
/// What work throws is thrown once all are done, that of the least k first.
void for_each_piece(Index count, const std::function<void(Index)>& work);

/// Number of threads for all later work; 0 leaves OpenMP's choice (OMP_NUM_THREADS, else all
/// cores).
void set_threads(int threads);
int threads();

}  // namespace dcnn
