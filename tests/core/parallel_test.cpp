// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "dcnn/core/interruptible.h"

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

TEST(Pieces, AreGivenUpWhereThatIsWished) {
  int begun = 0;
  bool wish = false;
  const auto piece = [&](Index) { ++begun; };
  {
    const Interruptible scope([&] { return wish; });
    for_each_piece(1, piece);
    wish = true;
    EXPECT_THROW(for_each_piece(1, piece), Interrupted);
  }
  EXPECT_EQ(begun, 1);
  for_each_piece(1, piece);  // the wish ended with its scope
  EXPECT_EQ(begun, 2);
}

TEST(Pieces, WhatThePieceOfLeastNumberThrowsComesOut) {
  std::vector<int> done(40, 0);
  const auto work = [&](Index k) {
    if (k == 7 || k == 31) throw std::runtime_error("piece " + std::to_string(k));
    done[static_cast<std::size_t>(k)] = 1;
  };
  try {
    for_each_piece(40, work);
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "piece 7");
  }
  EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), 38);
}

}  // namespace
}  // namespace dcnn
