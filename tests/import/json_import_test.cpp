// Logs in JSON, however their rows are nested, become the same recording.
#include <gtest/gtest.h>

#include "import/logs.h"

namespace dcnn {
namespace {

using test::cell;
using test::data_error;
using test::has_column;
using test::import_text;

struct Form {
  const char* name;
  const char* text;
};

class EveryForm : public ::testing::TestWithParam<Form> {};

TEST_P(EveryForm, GivesTheSameRecording) {
  const Imported imported = import_text(GetParam().text);
  ASSERT_EQ(imported.table.values.rows(), 3);
  for (Index row = 0; row < 3; ++row) {
    const auto k = static_cast<double>(row);
    EXPECT_NEAR(cell(imported, "t", row) - cell(imported, "t", 0), 0.01 * k, 1e-6);
    EXPECT_EQ(cell(imported, "fx", row), 1.5 + k);
    EXPECT_EQ(cell(imported, "fy", row), -0.25);
    EXPECT_EQ(cell(imported, "fz", row), 1000.0);
  }
}

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
