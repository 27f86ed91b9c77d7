// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/excerpt.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

TEST(Excerpt, LeavesAShortPrintableTextAsItIs) {
  EXPECT_EQ(excerpt(""), "");
  EXPECT_EQ(excerpt("f_x [N] naïve 力"), "f_x [N] naïve 力");
}

TEST(Excerpt, ShowsNothingThatATerminalObeys) {
  EXPECT_EQ(excerpt("\x1b[31mred"), "?[31mred");
  EXPECT_EQ(excerpt("a\tb\nc\rd\x7f"), "a?b?c?d?");
  EXPECT_EQ(excerpt("\xc2\x9b"
                    "31m"),
            "?31m")
      << "U+009B begins a control sequence, too";
  EXPECT_EQ(excerpt("\xc2\xa0"), "\xc2\xa0") << "U+00A0 is a space";
  EXPECT_EQ(excerpt(std::string_view("\0", 1)), "?");
  for (const char* turn : {"\u061c", "\u200e", "\u200f", "\u2028", "\u202e", "\u2066", "\u2069"}) {
    EXPECT_EQ(excerpt(turn), "?") << "what follows would stand elsewhere than it is";
  }
  for (const char* plain : {"\u061b", "\u200d", "\u2027", "\u202f", "\u2065", "\u206a"}) {
    EXPECT_EQ(excerpt(plain), plain);
  }
}

TEST(Excerpt, CutsBetweenCharactersAndSaysSo) {
  EXPECT_EQ(excerpt("abcdef", 6), "abcdef");
  EXPECT_EQ(excerpt("abcdefg", 6), "abcdef...");
  EXPECT_EQ(excerpt("ab力", 4), "ab...");
  EXPECT_EQ(excerpt(std::string(20'000'000, 'x')).size(), 83U);
}

TEST(Excerpt, ShowsBytesThatAreNoUtf8AsQuestionMarks) {
  EXPECT_EQ(excerpt("\xff\xc0\xaf\xe5\x8a"), "?????");
}

}  // namespace
}  // namespace dcnn
