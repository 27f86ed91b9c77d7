// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/csv.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cstring>
#include <fstream>

#include "data/testing.h"
#include "dcnn/core/error.h"
#include "dcnn/core/parallel.h"
#include "dcnn/core/random.h"

namespace dcnn {
namespace {

using testing::error_of;

using testing::temporary_file;

struct BadCase {
  const char* name;
  std::string text;
  std::vector<std::string> fragments;
};

std::vector<BadCase> bad_inputs() {
  const std::string nul(1, '\0');
  return {
      {"Empty", "", {"is empty", "header row"}},
      {"HeaderOnly", "t,fx\n", {"no samples"}},
      {"BlankHeader", "\nt,fx\n1,2\n", {":1:", "blank"}},
      {"NoHeader", "1,2\n3,4\n", {":1:", "no header row"}},
      {"DuplicateColumn", "t,fx,t\n1,2,3\n", {":1:", "'t'", "number 3", "twice"}},
      {"EmptyName", "t,,fx\n1,2,3\n", {":1:", "column 2 has no name"}},
      {"TooFew", "t,fx\n1,2\n3\n", {":3:", "1 cells", "2 columns"}},
      {"TooMany", "t,fx\n1,2,3\n", {":2:", "3 cells", "2 columns"}},
      {"TrailingComma", "t,fx\n1,2,\n", {":2:", "3 cells", "2 columns"}},
      {"EmptyCell", "t,fx,fy\n1,,3\n", {":2:", "'fx' is empty", "column 2 of 3"}},
      {"EmptyLastCell", "t,fx\n1,\n", {":2:", "'fx' is empty"}},
      {"Word", "t,fx\n1,2\n2,abc\n", {":3:", "column 'fx' is not a number: 'abc'", "decimal"}},
      {"Minus", "t,fx\n1,-\n", {":2:", "'fx' is not a number"}},
      {"TwoSigns", "t,fx\n1,+-2\n", {":2:", "'fx' is not a number"}},
      {"TwoNumbers", "t,fx\n1,2 3\n", {":2:", "'fx' is not a number: '2 3'"}},
      {"Nan", "t,fx\n1,nan\n", {":2:", "'fx' is not finite: 'nan'"}},
      {"NanCapitals", "t,fx\nNaN,1\n", {":2:", "'t' is not finite"}},
      {"NanPayload", "t,fx\nnan(1),1\n", {":2:", "'t'"}},
      {"MinusInf", "t,fx\n1,-Inf\n", {":2:", "'fx' is not finite"}},
      {"Infinity", "t,fx\n1,+INFINITY\n", {":2:", "'fx' is not finite"}},
      {"Hex", "t,fx\n1,0x1F\n", {":2:", "hexadecimal"}},
      {"DecimalComma", "t,fx\n0,5,1,5\n", {":2:", "4 cells", "decimal commas"}},
      {"Semicolons", "t;fx\n0,5;1,5\n", {":1:", "';'", "dcnn-import"}},
      {"SemicolonRow", "t,fx\n0.5;1.5\n", {":2:", "';'", "dcnn-import"}},
      {"SemicolonCell", "t,fx\n1,2;3\n", {":2:", "';'", "dcnn-import"}},
      {"Tabs", "t\tfx\n1\t2\n", {":1:", "tabs", "dcnn-import"}},
      {"TabRow", "t,fx\n1\t2\n", {":2:", "tab"}},
      {"TabCell", "t,fx\n1,\t2\n", {":2:", "tab"}},
      {"Spaces", "t fx\n1 2\n", {":1:", "spaces"}},
      {"Utf16LittleEndian", "\xFF\xFEt" + nul + ",", {":1:", "UTF-16"}},
      {"Utf16BigEndian", "\xFE\xFF" + nul + "t", {":1:", "UTF-16"}},
      {"Gzip", "\x1F\x8B\x08", {":1:", "gzip"}},
      {"Mcap", "\x89MCAP0\r\n\x01", {":1:", "log of another format", "dcnn-import"}},
      {"Latin1Header",
       "t,temp_\xB0"
       "C\n1,2\n",
       {":1:", "UTF-8"}},
      {"NulInHeader", "t" + nul + ",fx\n1,2\n", {":1:", "NUL"}},
      {"NulInRow", "t,fx\n1,2" + nul + "\n", {":2:", "'fx'", "NUL"}},
      {"QuotedHeader", "\"t\",\"fx\"\n1,2\n", {":1:", "quotes", "dcnn-import"}},
      {"QuotedCell", "t,fx\n1,\"2\"\n", {":2:", "'fx' is quoted"}},
      {"TooLarge", "t,fx\n1,1e999\n", {":2:", "'fx' is out of range"}},
      {"TooSmall", "t,fx\n1,-1e-999\n", {":2:", "'fx' is out of range"}},
      {"OldMacLines", "t,fx\r1,2\r", {":1:", "carriage return"}},
      {"CarriageReturnInCell", "t,fx\n1\r,2\n", {":2:", "'t' is not a number"}},
      {"BlankInside", "t,fx\n1,2\n\n3,4\n", {":3:", "blank line"}},
      {"LongLine", "t,fx\n1," + std::string(1200000, '1') + "\n", {":2:", "longer than"}},
      {"EndlessLine", "t,fx\n1," + std::string(4000000, '1'), {":2:", "longer than"}},
      {"LongCell", "t,fx\n1," + std::string(900, 'x') + "\n", {":2:", "xxx...'"}},
      {"TooManyColumns", std::string(150000, ',') + "\n", {":1:", "more than"}},
  };
}

TEST(Csv, RejectsEveryBadInputInOneLineThatSaysWhere) {
  for (const BadCase& bad : bad_inputs()) {
    const auto path = temporary_file("bad.csv", bad.text);
    const std::string message = error_of([&] { read_csv(path); }, Exit::kData);
    EXPECT_EQ(message.find(path.string()), 0u) << bad.name << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << bad.name;
    EXPECT_LT(message.size(), path.string().size() + 300) << bad.name;
    for (const std::string& fragment : bad.fragments) {
      EXPECT_NE(message.find(fragment), std::string::npos)
          << bad.name << ": '" << fragment << "' is not in: " << message;
    }
  }
}

TEST(Csv, RejectsWhatIsNoRegularFile) {
  EXPECT_NE(error_of([] { read_csv("/no/such.csv"); }, Exit::kData).find("check the path"),
            std::string::npos);
  EXPECT_NE(error_of([] { read_csv("/tmp"); }, Exit::kData).find("folder"), std::string::npos);
  EXPECT_NE(error_of([] { read_csv("/dev/zero"); }, Exit::kData).find("regular"),
            std::string::npos);
}

TEST(Csv, AcceptsTheHarmlessVariants) {
  const std::vector<std::string> same = {
      "t,fx\n0,1.5\n1,-2e3\n",        "t,fx\r\n0,1.5\r\n1,-2e3\r\n",
      "t,fx\n0,1.5\n1,-2e3",          "\xEF\xBB\xBFt,fx\n0,1.5\n1,-2e3\n",
      "t,fx\n0,1.5\n1,-2e3\n\n \n",   " t , fx \n0, +1.5 \n 1,-2E+3\n",
      "t,fx\n0.0,15e-1\n+1,-2000.\n",
  };
  for (const std::string& text : same) {
    const Table table = read_csv(temporary_file("good.csv", text));
    ASSERT_EQ(table.columns, (std::vector<std::string>{"t", "fx"})) << text;
    ASSERT_EQ(table.values.rows(), 2) << text;
    EXPECT_EQ(table.values(0, 1), 1.5) << text;
    EXPECT_EQ(table.values(1, 1), -2000.0) << text;
  }
}

TEST(Csv, DoesNotDependOnTheLocale) {
  const auto path = temporary_file("locale.csv", "t,fx\n0.5,1.25\n");
  for (const char* name : {"de_DE.UTF-8", "de_DE", "C"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    EXPECT_EQ(read_csv(path).values(0, 1), 1.25) << name;
  }
  std::setlocale(LC_ALL, "C");
}

TEST(Csv, ReadsBackTheSameBits) {
  Rng rng(1);
  Table table{{"a", "b", "c"}, Eigen::MatrixXd(3000, 3)};
  for (double& value : table.values.reshaped()) {
    do {
      const std::uint64_t bits = rng.bits();
      std::memcpy(&value, &bits, sizeof(value));
    } while (!std::isfinite(value));
  }
  const auto path = temporary_file("bits.csv", "");
  write_csv(path, table);
  const Table back = read_csv(path);
  ASSERT_EQ(back.columns, table.columns);
  ASSERT_EQ(back.values.rows(), table.values.rows());
  EXPECT_EQ(std::memcmp(back.values.data(), table.values.data(), sizeof(double) * 9000), 0);
}

TEST(Csv, RefusesToWriteWhatItCouldNotRead) {
  Table table{{"a"}, Eigen::MatrixXd::Constant(1, 1, std::nan(""))};
  error_of([&] { write_csv(temporary_file("nan.csv", ""), table); }, Exit::kFailure);
}

TEST(Csv, SurvivesLinesAcrossBlocks) {
  std::string text = "t,fx\n";
  for (int i = 0; i < 100000; ++i) text += std::to_string(i) + ".125," + std::to_string(-i) + "\n";
  const Table table = read_csv(temporary_file("blocks.csv", text));
  ASSERT_EQ(table.values.rows(), 100000);
  for (Index i = 0; i < 100000; ++i) ASSERT_EQ(table.values(i, 0), static_cast<double>(i) + 0.125);
}

TEST(Csv, AnyBytesAreReadOrRejected) {
  Rng rng(2);
  const std::string alphabet = "0123456789.,;\n\r\t +-eEnaNiInfx\"\0\xEF\xBB\xBFt";
  int read = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    std::string text = trial % 2 ? "a,b\n1,2\n" : "";
    const auto length = rng.below(60);
    for (std::uint64_t i = 0; i < length; ++i) {
      text += trial % 3 ? alphabet[rng.below(alphabet.size())] : static_cast<char>(rng.below(256));
    }
    const auto path = temporary_file("fuzz.csv", text);
    try {
      const Table table = read_csv(path);
      ++read;
      ASSERT_TRUE(table.values.allFinite());
      ASSERT_EQ(table.values.cols(), static_cast<Index>(table.columns.size()));
    } catch (const Error& error) {
      ASSERT_EQ(error.exit(), Exit::kData);
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace dcnn
