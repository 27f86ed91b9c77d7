// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace {

namespace fs = std::filesystem;

// Which rooms a room may include besides itself (docs: includes only point downwards).
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"core", {}},
    {"nn", {"core"}},
    {"data", {"core"}},
    {"physics", {"core", "data"}},
    {"models", {"core", "nn", "data", "physics"}},
    {"calibration", {"core", "data"}},
    {"identification", {"core", "data", "physics"}},  // laws and simulators are those of physics
    {"teleop", {"core", "data", "physics", "models", "calibration", "runtime"}},
    {"discovery", {"core", "data", "physics"}},  // laws for a residual, whoever left it
    {"diagnosis", {"core", "data", "physics", "discovery"}},
    {"design",
     {"core", "data", "physics", "identification",
      "diagnosis"}},                // motions for what a report leaves open
    {"conceal", {"core", "data"}},  // shares no physics with what it examines
    {"rivals", {"core", "data", "physics"}},
    {"cells", {"core"}},           // commands and files, whatever they are about
    {"import", {"core", "data"}},  // makes recordings, knows nothing of what is done with them
    {"runtime", {"core", "nn", "data", "physics", "models", "calibration"}},
    {"experiment",
     {"core", "nn", "data", "physics", "models", "diagnosis", "identification", "runtime",
      "calibration", "teleop", "check", "cells"}},
    {"check", {"core", "data", "physics"}},  // the nominal tool of sim.json
    {"tools",
     {"core", "nn", "data", "physics", "models", "diagnosis", "conceal", "rivals", "runtime",
      "experiment", "calibration", "teleop", "check", "identification", "import", "cells",
      "design"}}};

/// The includes in `text` that a file of `room` may not have.
std::vector<std::string> wrong_includes(const std::string& room, const std::string& text) {
  static const std::regex include(
      R"re((?:^|\n)\s*#\s*include\s*["<](?:dcnn/)?([a-z_]+)/([^">]+)[">])re");
  std::vector<std::string> wrong;
  for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it) {
    const std::string target = (*it)[1];
    if (!kMayInclude.contains(target) || target == room) continue;
    const auto allowed = kMayInclude.find(room);
    if (allowed == kMayInclude.end() || !allowed->second.contains(target)) {
      wrong.push_back(target + "/" + std::string((*it)[2]));
    }
  }
  return wrong;
}

struct Source {
  fs::path path;
  std::string room, text;
};

std::vector<Source> sources(const std::vector<std::string>& folders = {"include/dcnn", "src",
                                                                       "tools"}) {
  std::vector<Source> found;
  const fs::path root = DCNN_SOURCE_DIR;
  for (const auto& folder : folders) {
    for (const auto& file : fs::recursive_directory_iterator(root / folder)) {
      const auto extension = file.path().extension();
      if (extension != ".h" && extension != ".cpp" && extension != ".def") continue;
      std::ostringstream text;
      text << std::ifstream(file.path()).rdbuf();
      const auto inside = fs::relative(file.path(), root / folder);
      found.push_back(
          {file.path(), folder == "tools" ? "tools" : inside.begin()->string(), text.str()});
    }
  }
  return found;
}

TEST(Layering, CheckerSeesAWrongInclude) {
  EXPECT_TRUE(
      wrong_includes("models", "#include \"dcnn/nn/layer.h\"\n#include <vector>\n").empty());
  EXPECT_TRUE(
      wrong_includes("core", "#include <sys/stat.h>\n#include \"dcnn/core/file.h\"").empty());
  EXPECT_EQ(wrong_includes("core", "//\n#include \"dcnn/nn/layer.h\"").size(), 1U);
  EXPECT_EQ(wrong_includes("nn", "# include <dcnn/data/csv.h>").size(), 1U);
  EXPECT_EQ(wrong_includes("diagnosis", "#include \"models/a.h\"\n#include \"nn/b.h\"").size(), 2U);
  EXPECT_EQ(wrong_includes("unlisted", "#include \"dcnn/core/file.h\"").size(), 1U);
}

TEST(Layering, IncludesPointDownwards) {
  const auto all = sources();
  ASSERT_GT(all.size(), 20U);
  for (const auto& source : all) {
    for (const auto& include : wrong_includes(source.room, source.text)) {
      ADD_FAILURE() << source.path << ": " << source.room << " may not include " << include;
    }
  }
}

/// Types at the indentation of namespaces, with their namespace, but for unnamed ones.
std::vector<std::string> types_of(const std::string& text) {
  static const std::regex space(R"(^namespace ([\w:]*) ?\{)"),
      type(R"(^(?:struct|class|union|enum class) (\w+)(?: final)?(?: :[^;{]*)? ?\{)");
  std::vector<std::string> found;
  std::string inside;
  bool unnamed = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || std::string("scuen}").find(line[0]) == std::string::npos) continue;
    std::smatch match;
    if (line == "}  // namespace") unnamed = false;
    if (std::regex_search(line, match, space)) {
      if (match[1].length() == 0)
        unnamed = true;
      else
        inside = match[1];
    }
    if (!unnamed && std::regex_search(line, match, type)) {
      found.push_back(inside + "::" + std::string(match[1]));
    }
  }
  return found;
}

TEST(Layering, CheckerSeesTypes) {
  const auto types = types_of(
      "namespace dcnn {\nnamespace {\nstruct Own {\n};\n}  // namespace\n"
      "class Shared final : public Base {\n  struct Inner {\n  };\n};\nstruct Told;\n}\n");
  EXPECT_EQ(types, std::vector<std::string>{"dcnn::Shared"});
}

// Two types of one name in two files that never meet in one compile: the linker keeps the members
// of either for both (C++20 [basic.def.odr]).
TEST(Layering, NoTwoFilesDefineATypeOfOneName) {
  std::map<std::string, fs::path> defined;
  for (const auto& source : sources()) {
    if (source.room == "tools") continue;  // programs are linked one by one
    for (const std::string& type : types_of(source.text)) {
      const auto [first, is_new] = defined.emplace(type, source.path);
      EXPECT_TRUE(is_new || first->second == source.path)
          << type << " in " << source.path << " and " << first->second;
    }
  }
  EXPECT_GT(defined.size(), 200U);
}

TEST(Layering, EveryFileNamesItsLicence) {
  for (const auto& source : sources({"include", "src", "tools", "c", "tests", "fuzz", "bench"})) {
    EXPECT_LT(source.text.find("SPDX-License-Identifier: Apache-2.0"), 8U) << source.path;
  }
}

TEST(Layering, NoFileIsLongerThan300Lines) {
  for (const auto& source : sources()) {
    EXPECT_LE(std::count(source.text.begin(), source.text.end(), '\n'), 300) << source.path;
  }
}

}  // namespace
