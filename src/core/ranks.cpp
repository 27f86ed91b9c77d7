// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/ranks.h"

#include <algorithm>
#include <chrono>

namespace dcnn {
namespace {

Ranks* the_ranks = nullptr;
bool work_is_divided = false;
ExchangeCost the_cost;

void exchange_bytes(void* data, const std::vector<Index>& offsets) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  the_ranks->share(static_cast<std::byte*>(data), offsets);
  the_cost.seconds += std::chrono::duration<double>(Clock::now() - begin).count();
  the_cost.bytes += offsets.back();
  ++the_cost.count;
}

}  // namespace

void set_ranks(Ranks* ranks) { the_ranks = ranks; }
int rank_count() { return the_ranks ? the_ranks->count() : 1; }
bool is_first_rank() { return !the_ranks || the_ranks->index() == 0; }
const ExchangeCost& exchange_cost() { return the_cost; }

DividedWork::DividedWork() : before_(work_is_divided) { work_is_divided = rank_count() > 1; }
DividedWork::~DividedWork() { work_is_divided = before_; }

PieceRange own_pieces(Index pieces) {
  if (!work_is_divided) return {0, pieces};
  return {piece_begin(pieces, the_ranks->count(), the_ranks->index()),
          piece_begin(pieces, the_ranks->count(), the_ranks->index() + 1)};
}

void share_pieces(void* data, Index pieces, const std::function<Index(Index)>& offset) {
  if (!work_is_divided) return;
  std::vector<Index> offsets;
  for (int rank = 0; rank <= the_ranks->count(); ++rank) {
    offsets.push_back(offset(piece_begin(pieces, the_ranks->count(), rank)));
  }
  exchange_bytes(data, offsets);
}

bool any_rank(bool wish) {
  if (!the_ranks) return wish;
  std::vector<Index> offsets;
  for (int rank = 0; rank <= the_ranks->count(); ++rank) offsets.push_back(rank);
  std::vector<char> wishes(static_cast<std::size_t>(the_ranks->count()));
  wishes[static_cast<std::size_t>(the_ranks->index())] = wish ? 1 : 0;
  exchange_bytes(wishes.data(), offsets);
  return std::any_of(wishes.begin(), wishes.end(), [](char one) { return one != 0; });
}

}  // namespace dcnn
