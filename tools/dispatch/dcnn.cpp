// SPDX-License-Identifier: Apache-2.0
// `dcnn <verb> …` is `dcnn-<verb> …`; alone it lists the verbs.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "dcnn/core/error.h"
#include "dcnn/core/options.h"

namespace {

using namespace dcnn;

std::vector<std::string> verbs() {
  std::vector<std::string> all;
  std::istringstream list(DCNN_VERBS);
  for (std::string verb; list >> verb;) all.push_back(verb);
  return all;
}

/// Beside this program.
std::string program(const std::string& verb) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / ("dcnn-" + verb);
}

/// What a program prints about itself, in one line.
std::string summary(const std::string& verb) {
  FILE* pipe = ::popen(("'" + program(verb) + "' --summary 2>/dev/null").c_str(), "r");
  if (!pipe) return "";
  std::array<char, 1024> line{};
  if (!std::fgets(line.data(), line.size(), pipe)) line[0] = '\0';
  ::pclose(pipe);
  line[std::strcspn(line.data(), "\n")] = '\0';
  return line.data();
}

/// Verbs by what they are for, in the order in which a reader needs them.
const std::vector<std::pair<std::string, std::vector<std::string>>> kGroups{
    {"Recordings", {"import", "check", "sim"}},
    {"What a simulator leaves out", {"diagnose", "identify", "design", "forward"}},
    {"Models", {"train", "eval", "predict"}},
    {"On the robot", {"run", "calibrate", "teleop", "live"}},
    {"Studies", {"reproduce", "bench", "sweep", "conceal", "rivals"}}};

/// A verb and what it does in one sentence, in lines of 96 characters at most.
std::string row(const std::string& verb) {
  constexpr std::size_t kWidth = 96, kIndent = 14;
  std::istringstream words(summary(verb));
  std::string text =
      "  " + verb + std::string(kIndent - 3 - std::min<std::size_t>(verb.size(), 10), ' ');
  std::size_t column = kIndent - 1;
  std::string before;
  for (std::string word; words >> word; before = word) {
    if (before.ends_with('.') && before != "(Fig.") break;
    if (column + 1 + word.size() > kWidth) {
      text += "\n" + std::string(kIndent - 1, ' ');
      column = kIndent - 1;
    }
    text += " " + word;
    column += 1 + word.size();
  }
  return text + "\n";
}

void list() {
  std::cout << "DCNN Toolkit " DCNN_VERSION
               ": what a robot's tool does to its force sensor, from recordings.\n\n"
               "Usage: dcnn VERB [options]      the same as dcnn-VERB\n"
               "       dcnn help VERB           what it takes\n\n"
               "Examples:\n"
               "  dcnn diagnose --sim sim.json --fit log.csv --out report\n"
               "  dcnn train --train log.csv --out model.dcnn\n";
  std::vector<std::string> others = verbs();
  for (const auto& [heading, group] : kGroups) {
    std::cout << "\n" << heading << ":\n";
    for (const std::string& verb : group) {
      if (std::erase(others, verb) > 0) std::cout << row(verb);
    }
  }
  if (!others.empty()) std::cout << "\nOther:\n";
  for (const std::string& verb : others) std::cout << row(verb);
}

/// The exit code where standard output has taken everything, or not.
int written() {
  std::cout.flush();
  if (std::cout.good()) return static_cast<int>(Exit::kDone);
  std::cerr << "dcnn: standard output: cannot write\n";
  return static_cast<int>(Exit::kFailure);
}

int run(const std::string& verb, char** arguments) {
  std::string path = program(verb);
  arguments[0] = path.data();
  ::execv(path.c_str(), arguments);
  std::cerr << "dcnn: " << path << ": " << std::strerror(errno) << "\n";
  return static_cast<int>(Exit::kFailure);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "--help";
  if (first == "--version") {
    std::cout << "dcnn " DCNN_VERSION "\n";
    return written();
  }
  if (first == "--help" || first == "-h" || (first == "help" && argc == 2)) {
    list();
    return written();
  }
  const std::string verb = first == "help" ? argv[2] : first;
  const auto known = verbs();
  if (std::find(known.begin(), known.end(), verb) == known.end()) {
    const std::string near = nearest_word(verb, known);
    std::cerr << "dcnn: '" << verb << "' is no verb"
              << (near.empty() ? "; dcnn lists them" : "; did you mean '" + near + "'?") << "\n";
    return static_cast<int>(Exit::kUsage);
  }
  if (first != "help") return run(verb, argv + 1);
  std::string help = "--help";
  std::array<char*, 3> arguments{nullptr, help.data(), nullptr};
  return run(verb, arguments.data());
}
