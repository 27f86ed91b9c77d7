// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/container.h"

#include <gtest/gtest.h>
#include <sodium.h>
#include <sys/resource.h>

#include <csignal>
#include <limits>
#include <random>

#include "dcnn/core/file.h"
#include "models/container_header.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

Container example() {
  Container container;
  container.metadata = {{"model", R"({"name":"dcnn","layers":[]})"},
                        {"note", "Ω \"sha256\":\"0\n"}};
  container.tensors = {
      {"weight", {2, 3}, std::vector<float>{1, -2, 0.5F, 3e-30F, -0.0F, 6}},
      {"mean", {3}, std::vector<double>{0.1, -1e300, 5e-324}},
      {"rows", {1, 2}, std::vector<std::int64_t>{-1, std::numeric_limits<std::int64_t>::max()}},
      {"empty", {0, 4}, std::vector<float>{}},
      {"scalar", {}, std::vector<double>{2.5}}};
  return container;
}

void expect_rejected(const std::string& bytes, const std::string& what) {
  try {
    decode(bytes, "m.dcnn");
    ADD_FAILURE() << "accepted: " << what;
  } catch (const Error& error) {
    const std::string message = error.what();
    if (error.exit() != Exit::kModel || !message.starts_with("m.dcnn: ") ||
        message.find('\n') != std::string::npos) {
      ADD_FAILURE() << what << ": wrong kind of error: " << message;
    }
  }
}

std::string length_word(std::uint64_t length) {
  std::string word;
  for (int i = 0; i < 8; ++i) word += static_cast<char>(length >> (8 * i));
  return word;
}

const std::string kZeros(64, '0');

/// Gives `bytes` a correct checksum, as an attacker would; nothing where there is no place for it.
std::string sealed(std::string bytes) {
  const std::string key = R"("sha256":")";
  const auto found = bytes.find(key);
  if (found == std::string::npos || found + key.size() + 64 > bytes.size()) return bytes;
  const auto place = found + key.size();
  bytes.replace(place, 64, kZeros);
  unsigned char hash[32];
  crypto_hash_sha256(hash, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  char hex[65];
  return bytes.replace(place, 64, sodium_bin2hex(hex, sizeof hex, hash, sizeof hash));
}

std::string padded(std::string header) { return header.append((8 - header.size() % 8) % 8, ' '); }

/// A file of the given tensor entries ("name":{…},…) and data, with a correct checksum.
std::string forged(const std::string& entries, const std::string& data,
                   const std::string& metadata = R"("sha256":")" + kZeros + '"') {
  const auto header = padded(R"({"__metadata__":{)" + metadata + "}" +
                             (entries.empty() ? "" : ",") + entries + "}");
  return sealed(length_word(header.size()) + header + data);
}

std::string entry(const std::string& name, const std::string& dtype, const std::string& shape,
                  const std::string& offsets) {
  return '"' + name + R"(":{"dtype":")" + dtype + R"(","shape":[)" + shape +
         R"(],"data_offsets":[)" + offsets + "]}";
}

const std::string kEight(8, '\0');
const std::string kGood = entry("a", "F32", "2", "0,8");

TEST(Container, GivesBackWhatWasPutIn) {
  const auto container = example();
  auto read = decode(encode(container), "m.dcnn");
  EXPECT_EQ(read.metadata.at("sha256").size(), 64U);
  read.metadata.erase("sha256");
  EXPECT_EQ(read.metadata, container.metadata);
  ASSERT_EQ(read.tensors.size(), container.tensors.size());
  for (const auto& tensor : container.tensors) {
    ASSERT_NE(read.find(tensor.name), nullptr);
    EXPECT_EQ(read.find(tensor.name)->shape, tensor.shape);
    EXPECT_EQ(read.find(tensor.name)->values, tensor.values);
  }
  EXPECT_EQ(read.find("absent"), nullptr);
}

TEST(Container, OneContentHasOneSpelling) {
  const auto bytes = encode(example());
  EXPECT_EQ(encode(decode(bytes, "m.dcnn")), bytes);
  EXPECT_EQ(sealed(bytes), bytes) << "the checksum is SHA-256 over the file with its digits zeroed";
}

TEST(Container, HeaderAlignsTheDataToEightBytes) {
  for (std::size_t letters = 0; letters < 9; ++letters) {
    Container container;
    container.metadata["k"] = std::string(letters, 'x');
    container.tensors = {{"a", {1}, std::vector<double>{1}}};
    EXPECT_EQ(encode(container).size() % 8, 0U);
  }
}

TEST(Container, FloatsAreLittleEndian) {
  Container container;
  container.tensors = {{"a", {1}, std::vector<float>{1.0F}}};
  EXPECT_TRUE(encode(container).ends_with(std::string_view("\x00\x00\x80\x3f", 4)));
}

TEST(Container, ForgedFilesOfTheseTestsAreSoundApartFromTheirFault) {
  EXPECT_EQ(decode(forged(kGood, kEight), "m.dcnn").tensors.size(), 1U);
  EXPECT_TRUE(decode(forged("", ""), "m.dcnn").tensors.empty());
}

TEST(Container, EveryFlippedBitIsNoticed) {
  const auto bytes = encode(example());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    expect_rejected(damaged, "bit " + std::to_string(bit));
  }
}

TEST(Container, EveryTruncationIsNoticed) {
  const auto bytes = encode(example());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    expect_rejected(bytes.substr(0, length), "length " + std::to_string(length));
    expect_rejected(sealed(bytes.substr(0, length)), "sealed length " + std::to_string(length));
  }
}

TEST(Container, AppendedBytesAreNoticed) {
  const auto bytes = encode(example());
  for (const std::string& tail : {std::string(1, '\0'), std::string(" "), kEight, bytes}) {
    expect_rejected(bytes + tail, "tail");
    expect_rejected(sealed(bytes + tail), "sealed tail");
  }
}

TEST(Container, RejectsTensorsThatDoNotTileTheData) {
  const auto b = [](const std::string& offsets) { return "," + entry("b", "F32", "2", offsets); };
  expect_rejected(forged(kGood + b("0,8"), kEight), "overlap");
  expect_rejected(forged(kGood + b("4,12"), kEight + kEight), "partial overlap");
  expect_rejected(forged(kGood + b("16,24"), kEight + kEight + kEight), "hole");
  expect_rejected(forged(kGood + b("8,16"), kEight), "beyond the file");
  expect_rejected(forged(kGood + b("8,0"), kEight), "backwards");
  expect_rejected(forged(kGood, kEight + kEight), "data left over");
  expect_rejected(
      forged(entry("a", "F32", "2", "8,16") + "," + entry("b", "F32", "2", "0,8"), kEight + kEight),
      "wrong order");
  for (const char* offsets : {"-8,0", "0,-8", "0,18446744073709551615", "18446744073709551608,0",
                              "0,99999999999999999999999", "0,8.0", "0,8e0", "0", "0,8,8", "",
                              "00,8", "+0,8", "0,9223372036854775807", "null,8"}) {
    expect_rejected(forged(entry("a", "F32", "2", offsets), kEight), offsets);
  }
}

TEST(Container, RejectsShapesThatDoNotFit) {
  for (const char* shape : {"3", "1", "", "-2", "-1,-2", "2,", "4611686018427387906", "2.0", "02",
                            "[2]", "4194305,4194305,211106198978564", "4294967296,4294967296,2",
                            "9223372036854775807,9223372036854775807", "18446744073709551615",
                            "0,4194305,4194305,211106198978564", "1,1,1,1,1,1,1,1,2"}) {
    expect_rejected(forged(entry("a", "F32", shape, "0,8"), kEight), shape);
  }
  expect_rejected(forged(entry("a", "F32", "4194305,4194305,211106198978564", "0,0"), ""), "empty");
}

TEST(Container, RejectsForeignTypesAndValues) {
  for (const char* dtype : {"F16", "BF16", "I32", "U8", "f32", "", "F32 "}) {
    expect_rejected(forged(entry("a", dtype, "2", "0,8"), kEight), dtype);
  }
  const std::string float_nan("\x00\x00\xc0\x7f\x00\x00\x00\x00", 8);
  const std::string double_infinity("\x00\x00\x00\x00\x00\x00\xf0\xff", 8);
  expect_rejected(forged(kGood, float_nan), "NaN");
  expect_rejected(forged(entry("a", "F64", "1", "0,8"), double_infinity), "infinity");
}

TEST(Container, RejectsRepeatedAndUnknownKeys) {
  const std::string digest = R"("sha256":")" + kZeros + '"';
  expect_rejected(forged(kGood + "," + entry("a", "F32", "2", "8,16"), kEight + kEight),
                  "name twice");
  expect_rejected(forged(entry("__metadata__", "F32", "2", "0,8"), kEight), "reserved name");
  expect_rejected(forged(kGood, kEight, digest + "," + digest), "checksum twice");
  expect_rejected(forged(kGood, kEight, digest + R"(,"x":"1","x":"2")"), "key twice");
  expect_rejected(forged(kGood, kEight, R"("x":"1")"), "no checksum");
  expect_rejected(forged(kGood, kEight, R"("sha256":"00")"), "short checksum");
  expect_rejected(forged(R"("a":{"dtype":"F32","shape":[2],"data_offsets":[0,8],"x":1})", kEight),
                  "extra");
  expect_rejected(
      forged(R"("a":{"dtype":"F32","dtype":"F32","shape":[2],"data_offsets":[0,8]})", kEight),
      "dtype twice");
  expect_rejected(forged(R"("a":{"dtype":"F32","shape":[2]})", kEight), "no offsets");
}

TEST(Container, RejectsMetadataThatIsNotText) {
  for (const char* value :
       {"1", "null", "true", "{}", "[]", "\"\xff\"", "\"\\ud800\"", "\"\n\"", "\"", "\"\\"}) {
    expect_rejected(forged(kGood, kEight, R"("sha256":")" + kZeros + R"(","x":)" + value), value);
  }
}

TEST(Container, RejectsTheChecksumInCapitals) {
  auto bytes = encode(example());
  const auto place = bytes.find(R"("sha256":")") + 10;
  auto letter = bytes.find_first_of("abcdef", place);
  ASSERT_LT(letter, place + 64);
  bytes[letter] = static_cast<char>(bytes[letter] - 'a' + 'A');
  expect_rejected(bytes, "capital");
}

TEST(Container, RejectsOtherSpellingsOfTheSameHeader) {
  const std::string header = R"({"__metadata__":{"sha256":")" + kZeros + R"("},)" + kGood + "}";
  const auto file = [](const std::string& text) {
    return sealed(length_word(text.size()) + text + kEight);
  };
  ASSERT_NO_THROW(decode(file(padded(header)), "m.dcnn"));
  expect_rejected(file(padded(header) + std::string(8, ' ')), "eight more spaces");
  expect_rejected(file(padded(header + " ") + std::string(8, ' ')), "more spaces");
  expect_rejected(file(" " + padded(header)), "leading space");
  expect_rejected(file(header + std::string((8 - header.size() % 8) % 8, '\n')), "newlines");
  expect_rejected(file(header + std::string((8 - header.size() % 8) % 8, '\0')), "NULs");
  expect_rejected(file(padded(header + "{}")), "second document");
  auto escaped = header;
  escaped.replace(escaped.find("\"a\""), 3, R"("\u0061")");
  expect_rejected(file(padded(escaped)), "escape");
  auto spaced = header;
  spaced.replace(spaced.find(":["), 2, ": [");
  expect_rejected(file(padded(spaced)), "space after colon");
}

TEST(Container, RejectsHostileHeaderLengths) {
  const auto bytes = encode(example());
  const auto longest = std::numeric_limits<std::uint64_t>::max();
  for (const auto length : {longest, longest - 7, longest / 2, std::uint64_t{0}, std::uint64_t{1},
                            std::uint64_t{bytes.size()}, std::uint64_t{bytes.size() - 7}}) {
    expect_rejected(sealed(length_word(length) + bytes.substr(8)), std::to_string(length));
  }
  const std::string large(5 << 20, ' ');
  expect_rejected(length_word(large.size()) + large, "header of 5 MB");
}

TEST(Container, RejectsAHeaderThatGoesOnBeyondTheFile) {
  const auto header = padded(R"({"__metadata__":{"sha256":")" + kZeros + R"("}})");
  ASSERT_NO_THROW(decode(sealed(length_word(header.size()) + header), "m.dcnn"));
  for (const std::size_t beyond : {1U, 8U, 16U}) {
    expect_rejected(sealed(length_word(header.size() + beyond) + header), "a length too large");
  }
}

TEST(Container, TakesTheLongestHeaderAndNoneLonger) {
  const auto with_header_of = [](std::size_t bytes) {
    const std::string digest = R"("sha256":")" + kZeros + R"(","x":")";
    const std::size_t rest = std::string(R"({"__metadata__":{"}})").size() + digest.size();
    return forged("", "", digest + std::string(bytes - rest, 'x') + '"');
  };
  EXPECT_EQ(decode(with_header_of(kMaxHeaderBytes), "m.dcnn").metadata.size(), 2U);
  expect_rejected(with_header_of(kMaxHeaderBytes + 8), "a header of 4 MiB and 8 bytes");
}

TEST(Container, WritesNoDescriptionThatItWouldNotRead) {
  Container container;
  container.metadata["x"] = "";
  const std::size_t least = encode(container).size() - 8;
  container.metadata["x"] = std::string(kMaxHeaderBytes - least, 'x');
  EXPECT_EQ(decode(encode(container), "m.dcnn").metadata.at("x"), container.metadata["x"]);
  container.metadata["x"] += "12345678";
  EXPECT_THROW(encode(container), Error);
  container.metadata.clear();
  for (std::size_t k = 0; k < kMaxTensors; ++k) {
    container.tensors.push_back({std::to_string(k), {0}, std::vector<float>{}});
  }
  EXPECT_EQ(decode(encode(container), "m.dcnn").tensors.size(), kMaxTensors);
  container.tensors.push_back({"more", {0}, std::vector<float>{}});
  EXPECT_THROW(encode(container), Error);
}

TEST(Container, AChecksumThatIsMissingIsToldFromAWrongOne) {
  const auto said = [](const std::string& bytes) -> std::string {
    try {
      decode(bytes, "m.dcnn");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const auto of = [&](const std::string& metadata) {
    const auto header = padded(R"({"__metadata__":{)" + metadata + "}}");
    return said(length_word(header.size()) + header);
  };
  for (const char* none : {R"("x":"1")", R"("sha256":"00")", R"("sha256":"")"}) {
    EXPECT_NE(of(none).find("has no SHA-256 checksum"), std::string::npos) << of(none);
  }
  const std::string wrong = of(R"("sha256":")" + std::string(64, '1') + '"');
  EXPECT_NE(wrong.find("its SHA-256 checksum is wrong"), std::string::npos) << wrong;
}

TEST(Container, RejectsHeadersThatCostTime) {
  const std::string brackets(100'000, '[');
  expect_rejected(forged(brackets, ""), "brackets");
  expect_rejected(forged(entry("a", "F32", brackets, "0,8"), kEight), "brackets as shape");
  expect_rejected(length_word(brackets.size()) + brackets, "only brackets");
  std::string many, keys = R"("sha256":")" + kZeros + '"';
  for (int i = 0; i < 100'000; ++i) {
    const auto name = std::to_string(i);
    if (i < 50'000) many += (i ? "," : "") + entry(name, "F32", "0", "0,0");
    keys += ",\"" + name + "\":\"\"";
  }
  expect_rejected(forged(many, ""), "many tensors");
  expect_rejected(forged("", "", keys), "many keys out of order");
}

TEST(Container, NoMutationIsMisread) {
  const auto original = encode(example());
  const std::string spice = "\"{}[],:\\0189-eE.\xff ";
  std::mt19937 random(7);
  for (int round = 0; round < 20'000; ++round) {
    auto bytes = original;
    for (auto edits = 1 + random() % 4; edits > 0; --edits) {
      const auto place = random() % bytes.size();
      switch (random() % 4) {
        case 0:
          bytes[place] = static_cast<char>(random());
          break;
        case 1:
          bytes[place] = spice[random() % spice.size()];
          break;
        case 2:
          bytes.erase(place, 1 + random() % 8);
          break;
        default:
          bytes.insert(place, bytes.substr(random() % bytes.size(), random() % 16));
      }
      if (bytes.empty()) bytes = original;
    }
    bytes = sealed(bytes);
    try {
      ASSERT_EQ(encode(decode(bytes, "m.dcnn")), bytes);
    } catch (const Error& error) {
      ASSERT_EQ(error.exit(), Exit::kModel) << error.what();
    }
  }
}

class ContainerFile : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ =
      fs::path(::testing::TempDir()) / ("container" + std::to_string(::getpid()));
};

TEST_F(ContainerFile, IsReadAsItWasWritten) {
  write_container(folder_ / "m.dcnn", example());
  EXPECT_EQ(encode(read_container(folder_ / "m.dcnn")), encode(example()));
}

TEST_F(ContainerFile, MissingOrForeignFilesAreModelErrors) {
  write_file(folder_ / "foreign", "t,fx\n0,1\n");
  for (const auto& path : {folder_ / "absent", folder_, folder_ / "foreign"}) {
    try {
      read_container(path);
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::kModel);
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
    }
  }
}

TEST_F(ContainerFile, AFullDiskLeavesTheOldFileWhole) {
  const auto path = folder_ / "m.dcnn";
  write_container(path, example());
  auto larger = example();
  larger.tensors.push_back({"large", {4096}, std::vector<float>(4096, 1.0F)});
  // A limit on file size stops root too, in the middle of the write.
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit tight { 4096, before.rlim_max };
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  auto exit = Exit::kDone;
  try {
    write_container(path, larger);
  } catch (const Error& error) {
    exit = error.exit();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(exit, Exit::kFailure);
  EXPECT_EQ(encode(read_container(path)), encode(example()));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "a temporary file was left";
}

TEST_F(ContainerFile, WeightsThatAreNotFiniteAreNotWritten) {
  Container container;
  container.tensors = {{"w", {1}, std::vector<float>{std::nanf("")}}};
  EXPECT_THROW(write_container(folder_ / "m.dcnn", container), Error);
  container.tensors.clear();
  container.metadata["columns"] = "\xff";
  EXPECT_THROW(write_container(folder_ / "m.dcnn", container), Error);
  EXPECT_FALSE(fs::exists(folder_ / "m.dcnn"));
}

}  // namespace
}  // namespace dcnn
