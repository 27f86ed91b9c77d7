#include "dcnn/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>

namespace dcnn {
namespace {

TEST(Pieces, CoverTheBatchOnceWhateverItsSize) {
  for (Index n = 0; n < 300; ++n) {
    const Index pieces = piece_count(n);
    if (pieces > 0) {
      EXPECT_EQ(piece_begin(n, pieces, 0), 0);
      EXPECT_EQ(piece_begin(n, pieces, pieces), n);
    }
    for (Index k = 0; k < pieces; ++k) {
      EXPECT_LE(piece_begin(n, pieces, k + 1) - piece_begin(n, pieces, k), 13) << n;
    }
    if (n >= 4) {
      EXPECT_EQ(pieces % 4, 0) << n;
    }
  }
}

TEST(Pieces, EveryPieceIsWorkedOnOnce) {
  std::vector<std::atomic<int>> seen(100);
  for_each_piece(100, [&](Index k) { ++seen[static_cast<std::size_t>(k)]; });
  for (const auto& count : seen) EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace dcnn
