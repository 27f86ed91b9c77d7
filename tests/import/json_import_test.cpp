// SPDX-License-Identifier: Apache-2.0
// Logs in JSON, however their rows are nested, become the same recording.
#include <gtest/gtest.h>

#include "import/logs.h"

namespace dcnn {
namespace {

using test::data_error;
using test::has_column;
using test::import_text;

struct Form {
  const char* name;
  const char* text;
};

class EveryForm : public ::testing::TestWithParam<Form> {};

TEST_P(EveryForm, GivesTheSameRecording) { test::expect_three_rows(import_text(GetParam().text)); }

INSTANTIATE_TEST_SUITE_P(
    Json, EveryForm,
    ::testing::Values(
        Form{"lines",
             "{\"t\":0,\"fx\":1.5,\"fy\":-0.25,\"fz\":1e3}\n"
             "{\"t\":0.01,\"fx\":2.5,\"fy\":-0.25,\"fz\":1000}\r\n\n"
             "{\"t\":0.02,\"fx\":3.5,\"fy\":-0.25,\"fz\":1000}\n"},
        Form{"cut_line",
             "{\"t\":0,\"fx\":1.5,\"fy\":-0.25,\"fz\":1000}\n"
             "{\"t\":0.01,\"fx\":2.5,\"fy\":-0.25,\"fz\":1000}\n"
             "{\"t\":0.02,\"fx\":3.5,\"fy\":-0.25,\"fz\":1000}\n{\"t\":0.03,\"fx\":4."},
        Form{"nested_records",
             " [\n{\"t\":0,\"robot\":\"left\",\"wrench\":{\"force\":{\"x\":1.5,\"y\":-0.25,"
             "\"z\":1000}}},\n"
             "{\"t\":0.01,\"robot\":\"left\",\"wrench\":{\"force\":{\"x\":2.5,\"y\":-0.25,"
             "\"z\":1000}}},\n"
             "{\"t\":0.02,\"robot\":\"a \\\"NaN\\\"\",\"wrench\":{\"force\":{\"x\":3.5,"
             "\"y\":-0.25,\"z\":1000}}}]"},
        Form{"dates",
             "[{\"time\":\"2026-05-01T12:00:00.00Z\",\"force\":[1.5,-0.25,1000]},"
             "{\"time\":\"2026-05-01T12:00:00.01Z\",\"force\":[2.5,-0.25,1000]},"
             "{\"time\":\"2026-05-01T12:00:00.02Z\",\"force\":[3.5,-0.25,1000]}]"},
        Form{"lists",
             "\xEF\xBB\xBF{\"robot\": {\"name\": \"iiwa\", \"joints\": 7},\n \"data\": {"
             "\"t\": [0, 0.01, 0.02],\n \"fx\": [1.5, 2.5, 3.5], \"fy\": [-0.25, -0.25, -0.25],\n"
             "\"fz\": [1e3, 1e3, 1e3]}}\n"},
        Form{"rows_of_lists",
             "{\"t\": [0, 0.01, 0.02],\n\"force\": [[1.5, -0.25, 1000], [2.5, -0.25, 1000], "
             "[3.5, -0.25, 1000]]}\n"},
        Form{"samples",
             "{\"comment\": \"first\", \"samples\": [{\"t\":0,\"fx\":1.5,\"fy\":-0.25,\"fz\":1000},"
             "{\"t\":0.01,\"fx\":2.5,\"fy\":-0.25,\"fz\":1000},"
             "{\"t\":0.02,\"fx\":3.5,\"fy\":-0.25,\"fz\":1000}]}"}),
    [](const auto& form) { return form.param.name; });

TEST(JsonImport, WhatPythonWritesForNoNumberIsMissing) {
  const Imported imported = import_text(
      "{\"t\": [0, 0.01, 0.02, 0.03], \"fx\": [1, 2, 3, 4], \"fy\": [1, 1, 1, 1], "
      "\"fz\": [1, 1, 1, 1], \"unused\": [NaN, -Infinity, 1.0, null]}");
  EXPECT_EQ(imported.table.values.rows(), 4);
  EXPECT_FALSE(has_column(imported, "unused"));
}

TEST(JsonImport, WhatIsNoJsonIsNamedWithItsPlace) {
  const auto message = [](const char* text) { return data_error([&] { import_text(text); }); };
  const std::string middle = message("{\"t\":0,\"fx\":1}\n{\"t\":0.01,\"fx\":}\n{\"t\":0.02}\n");
  EXPECT_NE(middle.find("log.txt:2"), std::string::npos) << middle;
  const std::string document = message("{\"t\": [0, 1,\n 2}");
  EXPECT_NE(document.find("line 2"), std::string::npos) << document;
}

}  // namespace
}  // namespace dcnn
