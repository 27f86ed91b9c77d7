// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <ctime>

#include "dcnn/core/json.h"

namespace dcnn {
namespace {

void expect_rejected(const std::string& text) {
  try {
    parse_json(text, "a.json", Exit::kUsage);
    ADD_FAILURE() << "accepted: " << text.substr(0, 40);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage);
    EXPECT_TRUE(std::string(error.what()).starts_with("a.json: ")) << error.what();
  }
}

TEST(JsonHostile, DeepNestingIsRejectedNotFollowed) {
  expect_rejected(std::string(100'000, '['));
  expect_rejected(std::string(100'000, '[') + std::string(100'000, ']'));
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += R"({"a":)";
  expect_rejected(objects);
}

TEST(JsonHostile, NothingMayFollowTheDocument) {
  expect_rejected("{} {}");
  expect_rejected("{},");
  expect_rejected(std::string("{}\0", 3));
  expect_rejected(std::string("{}\0{\"a\":1}", 10));
}

TEST(JsonHostile, InvalidTextAndNumbersAreRejected) {
  for (const char* text :
       {"", " ", "\"\xff\"", "\"\xc0\xaf\"", "\"\\ud800\"", "1e999", "-1e999", "01", "NaN", "nan",
        "Infinity", "1.", "+1", "{\"a\":1,\"a\":1}", "/*x*/1", "'a'", "{\"a\":1,}"}) {
    expect_rejected(text);
  }
}

/// A tree that searches all members for each key, or all items after each list, takes minutes here.
TEST(JsonHostile, ManyKeysAndItemsAreReadInOnePass) {
  constexpr int kCount = 200'000;
  std::string keys = "{", items = "[";
  for (int i = 0; i < kCount; ++i) {
    keys += (i > 0 ? ",\"k" : "\"k") + std::to_string(i) + "\":{}";
    items += i > 0 ? ",[]" : "[]";
  }
  const std::clock_t before = std::clock();
  EXPECT_EQ(parse_json(keys + "}", "a.json", Exit::kUsage).size(), std::size_t{kCount});
  EXPECT_EQ(parse_json(items + "]", "a.json", Exit::kUsage).size(), std::size_t{kCount});
  EXPECT_LT(double(std::clock() - before) / CLOCKS_PER_SEC, 20.0);
  expect_rejected(keys + ",\"k7\":1}");
}

TEST(JsonHostile, ErrorsDoNotRepeatTheDocument) {
  const std::string huge(1'000'000, 'x');
  for (const std::string& text : {'"' + huge, huge, "{\"" + huge + "\":1,\"" + huge + "\":2}"}) {
    try {
      parse_json(text, "a.json", Exit::kUsage);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_LT(std::string(error.what()).size(), 500U);
    }
  }
}

TEST(JsonHostile, WholeNumbersBeyond64BitsBecomeDoubles) {
  EXPECT_EQ(parse_json("99999999999999999999", "a.json", Exit::kUsage).get<double>(), 1e20);
}

}  // namespace
}  // namespace dcnn
