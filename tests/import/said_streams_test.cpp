// SPDX-License-Identifier: Apache-2.0
// Streams by what their columns begin with, and the time as a column of --map.
#include "import/said_streams.h"

#include <gtest/gtest.h>

#include "import/logs.h"

namespace dcnn {
namespace {

using test::cell;

/// Two lists of lists of one width, as a script saves its trials.
constexpr const char* kTrials =
    "{\"slow\": [[0, 1, 5], [0.1, 2, 6], [0.2, 3, 7], [0.3, 4, 8]],\n"
    " \"fast\": {\"t\": [0, 0.1, 0.2], \"q\": [1, 2, 3]}}\n";

ForeignLog trials() {
  const test::TemporaryFolder folder;
  test::spill(folder / "trials.json", kTrials);
  return read_log({folder / "trials.json"}, {});
}

TEST(SaidStreams, OfArraysAreFoundByWhatTheirColumnsBeginWith) {
  const ForeignLog log = trials();
  ImportWishes wishes;
  wishes.use = {"fast", "arrays1"};
  EXPECT_EQ(resolved_wishes(log, wishes).use, (std::vector<std::string>{"arrays2", "arrays1"}));
  wishes.use = {"fast.q"};
  EXPECT_EQ(resolved_wishes(log, wishes).use, std::vector<std::string>{"arrays2"});
}

TEST(SaidStreams, ThatAreNotThereAreRefusedWithThoseThatAre) {
  const ForeignLog log = trials();
  ImportWishes wishes;
  wishes.use = {"fas"};
  try {
    resolved_wishes(log, wishes);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage);
    const std::string words = error.what();
    EXPECT_NE(words.find("--use 'fas'"), std::string::npos) << words;
    EXPECT_NE(words.find("arrays1 (slow[0] to slow[2]); arrays2 (fast.t, fast.q)"),
              std::string::npos)
        << words;
    EXPECT_EQ(words.find('\n'), std::string::npos) << words;
  }
}

TEST(SaidStreams, ATimeThatIsMappedIsTheClock) {
  ImportWishes wishes;
  wishes.use = {"slow"};
  wishes.map = {{"t", "slow[0]"}, {"q:left", "slow[1]"}, {"tau:left", "slow[2]"}};
  const Imported imported = test::import_text(kTrials, wishes);
  EXPECT_EQ(cell(imported, "t", 3), 0.3);
  EXPECT_EQ(cell(imported, "q_left", 3), 4.0);
  EXPECT_EQ(cell(imported, "tau_left", 3), 8.0);
}

TEST(SaidStreams, AreRefusedBesideJointsToo) {
  ImportWishes wishes;
  wishes.use = {"nothing"};
  wishes.map = {{"q:1", "slow[1]"}, {"tau:1", "slow[2]"}};
  EXPECT_THROW(propose(trials(), wishes), Error);
}

// A wrong unit makes wrong numbers, a wrong clock a wrong time: units come first.
TEST(SaidStreams, UnitsAreAskedForBeforeClocks) {
  const test::TemporaryFolder folder;
  test::spill(folder / "log.csv", "t,q1,tau1\n0,100,1\n5,110,2\n10,120,3\n15,130,4\n");
  const Proposal proposal = propose(read_log({folder / "log.csv"}, {}), {});
  ASSERT_EQ(proposal.guesses.size(), 2U);
  EXPECT_NE(proposal.guesses[0].find("--unit q:1=deg"), std::string::npos) << proposal.guesses[0];
  EXPECT_NE(proposal.guesses[0].find("mm of an axis that slides"), std::string::npos);
  EXPECT_NE(proposal.guesses[1].find("--clock-unit"), std::string::npos) << proposal.guesses[1];
}

}  // namespace
}  // namespace dcnn
