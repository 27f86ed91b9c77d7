// SPDX-License-Identifier: Apache-2.0
// Logs written by the libraries of their formats come back to the last bit.
#include <gtest/gtest.h>

#include <cstdlib>

#include "import/logs.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::cell;
using test::data_error;

/// What tests/import/write_logs.py writes; skips where Debian's Python lacks the library.
struct WrittenLog {
  const char* kind;
  const char* compression;
  const char* file;
};

bool write_log(const WrittenLog& log, const std::filesystem::path& path) {
  const std::string command = std::string("/usr/bin/python3 ") + DCNN_SOURCE_DIR +
                              "/tests/import/write_logs.py " + log.kind + " " + path.string() +
                              " " + log.compression + " 2>/dev/null";
  return std::system(command.c_str()) == 0;
}

class EveryWriter : public ::testing::TestWithParam<WrittenLog> {};

TEST_P(EveryWriter, ComesBackToTheLastBit) {
  const test::TemporaryFolder folder;
  const auto path = folder / GetParam().file;
  if (!write_log(GetParam(), path)) GTEST_SKIP() << "no library for " << GetParam().kind;
  ImportWishes wishes;
  wishes.quaternion_order = "wxyz";
  const std::string kind = GetParam().kind;
  if (kind == "db3") wishes.use = {"/ft/wrench", "/tf base>tool"};
  const Imported imported = test::import_log({path}, wishes);
  const bool messages = kind == "bag" || kind == "db3" || kind == "mcap";
  // A pose comes 1 ms after its force: the first force has none before it.
  const Index first = messages ? 1 : 0;
  ASSERT_EQ(imported.table.values.rows(), 500 - first);
  for (Index row = 0; row < imported.table.values.rows(); ++row) {
    const auto k = static_cast<double>(row + first);
    EXPECT_EQ(cell(imported, "fx", row), 0.1 * k);
    EXPECT_EQ(cell(imported, "fz", row), 1000.0 + k);
    EXPECT_EQ(cell(imported, "tx", row), 1e-3 * k);
    EXPECT_EQ(cell(imported, "tz", row), 2.0);
    // Stamps of 1.6e9 s are doubles within 0.12 us; the tool moves at 0.5 m/s.
    EXPECT_NEAR(cell(imported, "x", row), 1e-3 * (messages ? k - 0.5 : k), messages ? 2e-7 : 0.0);
    EXPECT_NEAR(cell(imported, "qw", row), 0.8, 1e-15);
    EXPECT_NEAR(cell(imported, "qz", row), 0.6, 1e-15);
    const double t = (messages ? 1600000000.5 : 0.0) + 2e-3 * k;
    EXPECT_NEAR(cell(imported, "t", row), t, 3e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Import, EveryWriter,
    ::testing::Values(
        WrittenLog{"bag", "none", "plain.bag"}, WrittenLog{"bag", "bz2", "bz2.bag"},
        WrittenLog{"bag", "lz4", "lz4.bag"}, WrittenLog{"db3", "none", "bag.db3"},
        WrittenLog{"mcap", "none", "plain.mcap"}, WrittenLog{"mcap", "lz4", "lz4.mcap"},
        WrittenLog{"mcap", "zstd", "zstd.mcap"}, WrittenLog{"npz", "none", "stored.npz"},
        WrittenLog{"npz", "deflate", "packed.npz"}, WrittenLog{"mat", "none", "plain.mat"},
        WrittenLog{"mat", "deflate", "packed.mat"}, WrittenLog{"mat4", "none", "four.mat"},
        WrittenLog{"mat73", "none", "hdf5.mat"}),
    [](const auto& instance) {
      return std::string(instance.param.kind) + "_" + instance.param.compression;
    });

TEST(BinaryLogs, StampsOfReceiptAreTakenWhenAskedFor) {
  const test::TemporaryFolder folder;
  const auto path = folder / "log.bag";
  if (!write_log({"bag", "none", ""}, path)) GTEST_SKIP() << "no python3-rosbag";
  ImportWishes wishes;
  wishes.stamps = "receive";
  EXPECT_NEAR(cell(test::import_log({path}, wishes), "t", 0), 1600000000.602, 3e-7);
}

TEST(BinaryLogs, JointsAndEffortsOfABagAreAnArm) {
  const test::TemporaryFolder folder;
  const auto path = folder / "log.bag";
  if (!write_log({"bag", "none", ""}, path)) GTEST_SKIP() << "no python3-rosbag";
  ImportWishes wishes;
  wishes.use = {"/joint_states"};
  const Imported imported = test::import_log({path}, wishes);
  ASSERT_EQ(imported.table.values.rows(), 100);
  EXPECT_EQ(cell(imported, "q_elbow", 3), -0.02 * 15);
  EXPECT_EQ(cell(imported, "tau_shoulder", 3), 1.0);
}

TEST(BinaryLogs, AnyMessageIsDecodedByItsDefinition) {
  const test::TemporaryFolder folder;
  const auto path = folder / "log.mcap";
  if (!write_log({"mcap", "none", ""}, path)) GTEST_SKIP() << "no python3";
  const ForeignLog log = read_log({path}, {});
  const auto odd = std::find_if(log.streams.begin(), log.streams.end(),
                                [](const LogStream& s) { return s.name == "/odd"; });
  ASSERT_NE(odd, log.streams.end());
  ASSERT_EQ(odd->rows, 500);
  const auto value = [&](const char* channel) {
    const Index at = odd->find(channel);
    EXPECT_GE(at, 0) << channel;
    return at < 0 ? std::nan("") : odd->channels[static_cast<std::size_t>(at)].values.at(7);
  };
  EXPECT_EQ(value("flags[2]"), 1.0);
  EXPECT_EQ(value("small"), -7.0);
  EXPECT_EQ(value("few[1]"), 7.0);
  EXPECT_EQ(value("inner[0].a"), -1.0);
  EXPECT_EQ(value("inner[1].b"), 7.0);
  EXPECT_EQ(value("last"), -1e12);
  EXPECT_LT(odd->find("image[0]"), 0);
}

/// Cut off anywhere: an error. A flipped byte of the head: an error or a log, no crash.
TEST(BinaryLogs, DamagedFilesAreErrors) {
  const test::TemporaryFolder folder;
  for (const WrittenLog& log :
       {WrittenLog{"bag", "lz4", "a.bag"}, WrittenLog{"db3", "none", "a.db3"},
        WrittenLog{"mcap", "zstd", "a.mcap"}, WrittenLog{"npz", "deflate", "a.npz"},
        WrittenLog{"mat", "none", "a.mat"}, WrittenLog{"mat", "deflate", "b.mat"},
        WrittenLog{"mat4", "none", "c.mat"}}) {
    const auto path = folder / log.file;
    if (!write_log(log, path)) continue;
    const std::string bytes = test::slurp(path);
    const auto attempt = [&](const std::string& damaged) {
      test::spill(path, damaged);
      try {
        read_log({path}, {});
        return true;
      } catch (const Error& error) {
        EXPECT_EQ(error.exit(), Exit::kData) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return false;
      }
    };
    int accepted = 0;
    for (std::size_t k = 1; k <= 15; ++k) {
      accepted += attempt(bytes.substr(0, bytes.size() * k / 16));
    }
    EXPECT_EQ(accepted, 0) << log.file;
    for (std::size_t at = 0; at < std::min<std::size_t>(bytes.size(), 1300); at += 26) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ 0xFF);
      attempt(damaged);
    }
  }
}

// libmatio reads what is missing as zeros.
TEST(BinaryLogs, OfMatlabThatAreCutKeepTheirWholeVariablesOnly) {
  const test::TemporaryFolder folder;
  const auto path = folder / "a.mat";
  if (!write_log({"mat", "deflate", ""}, path)) GTEST_SKIP() << "no python3-scipy";
  const std::string bytes = test::slurp(path);
  test::spill(path, bytes.substr(0, bytes.size() - 100));
  const std::string words = data_error([&] { read_log({path}, {}); });
  EXPECT_NE(words.find("--truncated"), std::string::npos) << words;
  ReadLogOptions read;
  read.accept_truncated = true;
  const auto channels_of = [](const ForeignLog& log) {
    std::size_t count = 0;
    for (const LogStream& stream : log.streams) count += stream.channels.size();
    return count;
  };
  const ForeignLog cut = read_log({path}, read);
  test::spill(path, bytes);
  const ForeignLog whole = read_log({path}, {});
  EXPECT_LT(channels_of(cut), channels_of(whole));
  EXPECT_NE(cut.notes.at(0).find("cut off"), std::string::npos);
}

// One recording in each cell, of its own length.
TEST(BinaryLogs, CellsOfMatlabAreStreams) {
  const test::TemporaryFolder folder;
  const auto path = folder / "a.mat";
  if (!write_log({"cells_mat", "none", ""}, path)) GTEST_SKIP() << "no python3-scipy";
  const ForeignLog log = read_log({path}, {});
  ASSERT_EQ(log.streams.size(), 2U);
  for (const LogStream& stream : log.streams) {
    const Index k = stream.rows == 100 ? 0 : 1;
    EXPECT_EQ(stream.rows, 100 + 50 * k);
    const Index at = stream.find("swing{" + std::to_string(k + 1) + "}[2]");
    ASSERT_GE(at, 0);
    EXPECT_EQ(stream.channels[static_cast<std::size_t>(at)].low, 10.0 * static_cast<double>(k));
  }
  ImportWishes wishes;
  wishes.map = {{"q:1", "swing{2}[1]"}, {"tau:1", "swing{2}[2]"}};
  wishes.clock = {"swing{2}[0]"};
  EXPECT_EQ(test::import_log({path}, wishes).table.values.rows(), 150);
}

// NumPy and MATLAB: N x 3 x 3, N x 4 x 4 and 4 x 4 x N.
TEST(BinaryLogs, ListsOfMatricesAreOrientationsAndPositions) {
  const test::TemporaryFolder folder;
  for (const char* kind : {"matrices_npz", "matrices_mat"}) {
    const auto path = folder / (std::string("a.") + (kind + 9));
    if (!write_log({kind, "none", ""}, path)) GTEST_SKIP() << "no library";
    const Imported imported = test::import_log({path});
    EXPECT_NEAR(cell(imported, "x", 7), 7e-3, 1e-15) << kind;
    EXPECT_NEAR(cell(imported, "z", 7), -0.25, 1e-15) << kind;
    EXPECT_NEAR(std::abs(cell(imported, "qw", 7)), 0.8, 1e-12) << kind;
    EXPECT_NEAR(cell(imported, "qz", 7) * cell(imported, "qw", 7), 0.48, 1e-12) << kind;
    EXPECT_EQ(cell(imported, "fz", 7), 1007.0);
  }
}

/// A zip archive of one empty file.
std::string archive_of(const std::string& name) {
  const std::string length{static_cast<char>(name.size()), '\0'};
  const std::string local =
      "PK\x03\x04" + std::string(22, '\0') + length + std::string(2, '\0') + name;
  const std::string central =
      "PK\x01\x02" + std::string(24, '\0') + length + std::string(16, '\0') + name;
  const std::string begin{static_cast<char>(local.size()), '\0', '\0', '\0'};
  const std::string size{static_cast<char>(central.size()), '\0', '\0', '\0'};
  const std::string one{'\1', '\0'};
  return local + central + "PK\x05\x06" + std::string(4, '\0') + one + one + size + begin +
         std::string(2, '\0');
}

TEST(BinaryLogs, FormatsOfOthersAreNamedWithWhatMakesALogOfThem) {
  const std::pair<std::string, const char*> files[] = {
      {archive_of("xl/workbook.xml"), "spreadsheet"},
      {archive_of("photo.png"), "without NumPy arrays"},
      {std::string("\x80\x04\x95\0\0", 5), "pickle"},
      {"\x89HDF\r\n\x1A\n", "HDF5"},
      {"PAR1....", "Parquet"},
      {std::string("\x93NUMPY\1\0\x40\0", 10) +
           "{'descr': '|O', 'fortran_order': False, 'shape': (10,), }       \n",
       "Python objects"}};
  const test::TemporaryFolder folder;
  for (const auto& [bytes, words] : files) {
    test::spill(folder / "log.bin", bytes);
    const std::string message = test::data_error([&] { read_log({folder / "log.bin"}, {}); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace dcnn
