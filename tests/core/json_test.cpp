// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace dcnn {
namespace {

TEST(Json, BracesOfPairsAreAnObjectAndOtherBracesAList) {
  const Json object{{"b", 1}, {"a", {0.5, 2}}, {"c", nullptr}};
  EXPECT_EQ(object.dump(), R"({"b":1,"a":[0.5,2],"c":null})");
  EXPECT_EQ((Json{1, "two", true}.dump()), R"([1,"two",true])");
  EXPECT_EQ((Json{{1, 2}, {3, 4}}.dump()), "[[1,2],[3,4]]");
  EXPECT_EQ(Json::array({{"a", 1}}).dump(), R"([["a",1]])");
  EXPECT_EQ(Json::object().dump(), "{}");
}

TEST(Json, BracesRoundOneElementAreAList) {
  const Json one = 1;
  EXPECT_EQ((Json{{"a", {one}}}.dump()), R"({"a":[1]})");
  EXPECT_EQ((Json{{"a", {"x"}}, {"b", {nullptr}}, {"c", {{{"d", 2}}}}}.dump()),
            R"({"a":["x"],"b":[null],"c":[{"d":2}]})");
  EXPECT_EQ((Json{{"a", {std::string("x")}}}.dump()), R"({"a":["x"]})");
  EXPECT_EQ(Json::array({one}).dump(), "[1]");
  EXPECT_EQ((Json{1.5}.dump()), "[1.5]");
}

TEST(Json, KeepsTheOrderAndTheKindOfWhatItParses) {
  const std::string text =
      R"({"z":18446744073709551615,"a":-9223372036854775808,"m":1.0,"e":[],"o":{},"t":"\"é\\","f":false})";
  EXPECT_EQ(Json::parse(text).dump(), text);
  EXPECT_EQ(Json::parse(text)["z"].get<std::uint64_t>(), std::numeric_limits<std::uint64_t>::max());
}

TEST(Json, BytesThatAreNoUtf8ArePrintedAsReplacementCharacters) {
  EXPECT_EQ(Json("l\xff.csv").dump(), "\"l\uFFFD.csv\"");
  EXPECT_EQ((Json{{"\xc0", 1}}).dump(), "{\"\uFFFD\":1}");
}

TEST(Json, IndentsAsAsked) {
  EXPECT_EQ((Json{{"a", {1, 2}}}.dump(2)), "{\n  \"a\": [\n    1,\n    2\n  ]\n}");
}

TEST(Json, NumbersAreEqualByValueAcrossTheirKinds) {
  EXPECT_EQ(Json(1), Json(1U));
  EXPECT_EQ(Json(1), Json(1.0));
  EXPECT_EQ(Json(2.5), 2.5);
  EXPECT_NE(Json(-1), Json(std::numeric_limits<std::uint64_t>::max()));
  EXPECT_NE(Json(1), Json(true));
  EXPECT_NE(Json("1"), 1);
  EXPECT_EQ(Json("one"), "one");
}

TEST(Json, ObjectsAreEqualKeyByKeyInOrder) {
  EXPECT_EQ((Json{{"a", 1}, {"b", 2}}), (Json{{"a", 1.0}, {"b", 2}}));
  EXPECT_NE((Json{{"a", 1}, {"b", 2}}), (Json{{"b", 2}, {"a", 1}}));
}

TEST(Json, NotFiniteIsPrintedAsNull) {
  EXPECT_EQ((Json{std::nan(""), std::numeric_limits<double>::infinity()}.dump()), "[null,null]");
}

TEST(Json, WhatAValueIsNotIsAnException) {
  const Json json{{"text", "a"}, {"list", {1, 2}}, {"huge", 1e300}};
  EXPECT_THROW(json["text"].get<double>(), Json::exception);
  EXPECT_THROW(json["list"].get<std::string>(), Json::exception);
  EXPECT_THROW(json["list"].get<bool>(), Json::exception);
  EXPECT_THROW(json["text"].get<std::vector<double>>(), Json::exception);
  EXPECT_THROW(json["huge"].get<std::int64_t>(), Json::exception);
  EXPECT_THROW(json["absent"], Json::exception);
  EXPECT_THROW(json["list"][2], Json::exception);
  EXPECT_THROW(json["list"].value("a", 1.0), Json::exception);
  EXPECT_THROW(Json(std::nan("")).get<int>(), Json::exception);
  EXPECT_THROW(Json::parse("{"), Json::exception);
  EXPECT_THROW(Json(1)["a"] = 2, Json::exception);
  EXPECT_THROW(Json("a").push_back(1), Json::exception);
}

TEST(Json, NullBecomesWhatIsAskedOfIt) {
  Json object, list, grown;
  object["a"]["b"] = 1;
  list.push_back("x");
  grown[2] = 3;
  EXPECT_EQ(object.dump(), R"({"a":{"b":1}})");
  EXPECT_EQ(list.dump(), R"(["x"])");
  EXPECT_EQ(grown.dump(), "[null,null,3]");
  EXPECT_TRUE(Json().items().empty());
}

TEST(Json, IsWalkedItemByItemValueByValueOrAsItself) {
  const auto sum = [](const Json& json) {
    double total = 0.0;
    for (const Json& item : json) total += item.get<double>();
    return total;
  };
  EXPECT_EQ(sum({1, 2.5}), 3.5);
  EXPECT_EQ(sum({{"a", 1}, {"b", 4}}), 5.0);
  EXPECT_EQ(sum(7), 7.0);
  EXPECT_EQ(sum(nullptr) + sum(Json::object()) + sum(Json::array()), 0.0);
  Json doubled{{"a", 1}, {"b", 4}};
  for (Json& value : doubled) value = 2 * value.get<int>();
  EXPECT_EQ(doubled.dump(), R"({"a":2,"b":8})");
}

TEST(Json, ConvertsToTheTypesOfTheField) {
  const Json json{
      {"x", 2}, {"names", {"a", "b"}}, {"rows", {{1.0, 2.0}, {3.0}}}, {"m", {{"k", 4.0}}}};
  const double x = json["x"];
  const std::vector<std::string> names = json["names"];
  const std::vector<std::vector<double>> rows = json["rows"];
  const std::map<std::string, double> members = json["m"];
  EXPECT_EQ(x, 2.0);
  EXPECT_EQ(names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(rows[0][1] + rows[1][0], 5.0);
  EXPECT_EQ(members.at("k"), 4.0);
  EXPECT_EQ(Json(names), json["names"]);
  EXPECT_EQ(Json(members), json["m"]);
  EXPECT_EQ(json.value("x", 7), 2);
  EXPECT_EQ(json.value("y", "none"), "none");
}

TEST(Json, UpdatesErasesAndCopies) {
  Json json{{"a", 1}, {"b", 2}, {"l", {1, 2, 3}}};
  const Json before = json;
  json.update({{"b", 3}, {"c", 4}});
  json.erase("a");
  json["l"].erase(1);
  EXPECT_EQ(json.dump(), R"({"b":3,"l":[1,3],"c":4})");
  EXPECT_EQ(before.dump(), R"({"a":1,"b":2,"l":[1,2,3]})");
  for (auto& [key, value] : json.items()) value = key;
  EXPECT_EQ(json.dump(), R"({"b":"b","l":"l","c":"c"})");
}

}  // namespace
}  // namespace dcnn
