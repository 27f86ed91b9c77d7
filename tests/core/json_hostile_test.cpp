#include <gtest/gtest.h>

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

TEST(JsonHostile, WholeNumbersBeyond64BitsBecomeDoubles) {
  EXPECT_EQ(parse_json("99999999999999999999", "a.json", Exit::kUsage).get<double>(), 1e20);
}

}  // namespace
}  // namespace dcnn
