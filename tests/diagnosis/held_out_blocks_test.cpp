// SPDX-License-Identifier: Apache-2.0
// Which pieces of a recording without another one are held out.
#include <gtest/gtest.h>

#include "diagnosis/holdout.h"

namespace dcnn {
namespace {

/// Held-out pieces of one recording of so many seconds.
std::vector<Span> held_out_of(double seconds) {
  constexpr double kStepHeld = 0.01;
  Case study;
  Log& log = study.logs.emplace_back();
  const auto rows = static_cast<Index>(seconds / kStepHeld) + 1;
  log.motion.dt = kStepHeld;
  log.motion.t = Eigen::VectorXd::LinSpaced(rows, 0.0, kStepHeld * double(rows - 1));
  log.motion.segments = {{0, rows}};
  log.motion.R_BS.resize(static_cast<std::size_t>(rows));
  return held_out_blocks(study, false);
}

// Of a motion there and back within 24 s one piece of 5 s is one place, and the only one.
TEST(HeldOutBlocks, ShortRecordingsHaveSeveral) {
  for (const double seconds : {24.0, 40.0, 80.0}) {
    const auto spans = held_out_of(seconds);
    EXPECT_EQ(spans.size(), 4U) << seconds;
    for (const Span& span : spans) EXPECT_NEAR(span.end - span.begin, seconds / 20.0, 1e-9);
  }
  const auto longer = held_out_of(200.0);
  EXPECT_EQ(longer.size(), 8U);
  EXPECT_NEAR(longer.front().end - longer.front().begin, 5.0, 1e-9);
}

// About a fifth of any, in pieces of a second or, where it has no three of them, one.
TEST(HeldOutBlocks, AFifthIsHeldOut) {
  for (const double seconds : {2.0, 4.0, 10.0, 15.0, 24.0, 100.0, 250.0}) {
    double held = 0.0;
    for (const Span& span : held_out_of(seconds)) held += span.end - span.begin;
    EXPECT_NEAR(held / seconds, 0.2, 0.0501) << seconds;
  }
}

}  // namespace
}  // namespace dcnn
