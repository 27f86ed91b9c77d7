// SPDX-License-Identifier: Apache-2.0
// Processes that train one network together: each works on its share of the pieces of a batch
// (core/parallel.h), and all hold the whole before it is used, so that sums over pieces are added
// in the same order and have the same bytes as in one process.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

/// The way from one process to the others; all call share() in the same order.
class Ranks {
 public:
  Ranks(int index, int count) : index_(index), count_(count) {}
  virtual ~Ranks() = default;
  int index() const { return index_; }
  int count() const { return count_; }
  /// Bytes [offsets[r], offsets[r + 1]) of rank r come to all others.
  virtual void share(std::byte* data, const std::vector<Index>& offsets) = 0;

 private:
  int index_, count_;
};

/// From now on this process works with others; null: by itself.
void set_ranks(Ranks* ranks);
int rank_count();
/// The first of them alone writes files and prints; the others compute.
bool is_first_rank();

/// While one lives, work on the pieces of a batch is divided among the ranks.
class DividedWork {
 public:
  DividedWork();
  ~DividedWork();
  DividedWork(const DividedWork&) = delete;
  DividedWork& operator=(const DividedWork&) = delete;

 private:
  bool before_;
};

struct PieceRange {
  Index begin, end;
};
/// Of `pieces`, those of this process: all of them where work is not divided.
PieceRange own_pieces(Index pieces);
/// Makes what every rank has written of its pieces known to all; piece k is the bytes from
/// offset(k) to offset(k + 1). Nothing where work is not divided.
void share_pieces(void* data, Index pieces, const std::function<Index(Index)>& offset);
/// Whether any rank wishes it: the same answer for all of them. Waits for all.
bool any_rank(bool wish);
/// What exchanges have cost this process so far: waiting for others included.
struct ExchangeCost {
  double seconds = 0.0;
  std::int64_t count = 0, bytes = 0;  ///< bytes that all hold afterwards
};
const ExchangeCost& exchange_cost();

}  // namespace dcnn
