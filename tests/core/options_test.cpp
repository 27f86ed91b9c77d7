// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/options.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Options, ReadsValuesAndFallsBackToDefaults) {
  Options options(Json{{"batch", 50}, {"lr", 1e-3}}, "c.json", Exit::kUsage);
  EXPECT_EQ(options.get("batch", 10), 50);
  EXPECT_EQ(options.get("epochs", 30), 30);
  EXPECT_DOUBLE_EQ(options.number("lr", 0.0, 0.0, 1.0), 1e-3);
  EXPECT_NO_THROW(options.finish());
}

TEST(Options, RefusesAnUnknownKeyAndSuggestsTheNearest) {
  Options options(Json{{"batches", 50}}, "c.json", Exit::kUsage);
  options.get("batch", 10);
  EXPECT_EQ(message_of([&] { options.finish(); }),
            "c.json: key 'batches' is unknown; did you mean 'batch'?");
}

TEST(NearestWord, IsASlipOfTheFingersAndNoOtherWord) {
  const std::vector<std::string> options{"--fit",  "--out",     "--holdout", "--seed",
                                         "--json", "--report",  "--train",   "--limits",
                                         "--on",   "--resample"};
  for (const auto& [typed, meant] : {std::pair{"--trian", "--train"},
                                     {"--holdut", "--holdout"},
                                     {"--ftt", "--fit"},
                                     {"--output", "--out"},
                                     {"--limit", "--limits"},
                                     {"--sede", "--seed"},
                                     {"-seed", "--seed"},
                                     {"--resampel", "--resample"},
                                     {"--hodlotu", "--holdout"}}) {
    EXPECT_EQ(nearest_word(typed, options), meant) << typed;
  }
  for (const char* other : {"--root", "--peer", "--samples", "--join", "--repeat", "--export",
                            "--seal", "--tip", "--onnx", "--a", "--", ""}) {
    EXPECT_EQ(nearest_word(other, options), "") << other;
  }
}

TEST(Options, NamesTheWholePathOfANestedKey) {
  Options options(Json{{"map", {{"sigma", "sd"}}}}, "c.json", Exit::kUsage);
  Options map = options.child("map");
  EXPECT_NE(message_of([&] {
              map.choice("sigma", "std", {"std", "variance"});
            }).find("'map.sigma'"),
            std::string::npos);
}

TEST(Options, ConvertsNothingSilently) {
  Options options(Json{{"batch", 1.5}, {"on", 1}, {"lr", "fast"}, {"word", 3}}, "c.json",
                  Exit::kUsage);
  EXPECT_THROW(options.get("batch", 1), Error);
  EXPECT_THROW(options.get("on", true), Error);
  EXPECT_THROW(options.get("lr", 0.1), Error);
  EXPECT_THROW(options.get<std::string>("word", ""), Error);
}

TEST(Options, MissingKeyIsAnErrorWithItsExitCode) {
  Options options(Json::object(), "sim.json", Exit::kData);
  try {
    options.get<double>("mass_kg");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData);
  }
}

TEST(Json, RefusesDuplicateKeysAndDeepNesting) {
  EXPECT_THROW(parse_json(R"({"a": 1, "a": 2})", "x", Exit::kUsage), Error);
  EXPECT_NO_THROW(parse_json(R"({"a": {"a": 1}, "b": [{"a": 2}]})", "x", Exit::kUsage));
  EXPECT_THROW(parse_json(std::string(100000, '['), "x", Exit::kUsage), Error);
  EXPECT_THROW(parse_json(std::string(1000, '[') + std::string(1000, ']'), "x", Exit::kUsage),
               Error);
}

TEST(Json, FaultsNameLineAndColumn) {
  const auto text = message_of([] { parse_json("{\n  \"a\": ,\n}", "x.json", Exit::kUsage); });
  EXPECT_NE(text.find("x.json"), std::string::npos);
  EXPECT_NE(text.find("line 2"), std::string::npos) << text;
}

}  // namespace
}  // namespace dcnn
