// SPDX-License-Identifier: Apache-2.0
#include "experiment/peers/helpers.h"

#include <cstdlib>

namespace dcnn {
namespace {

struct Library {
  const char* program;  ///< behind dcnn-peer-
  const char* name;
  bool reads_onnx;
};
constexpr Library kLibraries[] = {{"onnxruntime", "ONNX Runtime", true},
                                  {"onednn", "oneDNN", false},
                                  {"libtorch", "libtorch", false}};

void greet(Child& child, const Library& library, Peer& peer) {
  try {
    const Json greeting = child.hear();
    peer.version = greeting.value("version", "");
    peer.missing = greeting.value("missing", "");
    peer.host = greeting.value("host", "");
    peer.trains = greeting.value("trains", false);
  } catch (const Error&) {
    peer.missing = library.reads_onnx
                       ? "Node.js: tools/install-deps --peers"
                       : "its library does not load: tools/install-deps --peers, then build again";
  }
}

}  // namespace

Workplace::Workplace() {
  std::string pattern =
      (std::filesystem::temp_directory_path() / "dcnn-peers-").string() + std::string(6, 'X');
  require(::mkdtemp(pattern.data()) != nullptr, Exit::kFailure, pattern,
          ": cannot make a folder; set TMPDIR to one that is writable");
  path = pattern;
}

Workplace::~Workplace() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

void Helper::load(Index batch, int threads) const {
  child->ask("load " + std::to_string(batch) + " " + std::to_string(threads) + " " + kSamplesFile +
             " " + (reads_onnx ? kOnnxFile : kNetworkFile));
}

void Helper::load_nothing() const {
  child->ask(std::string("nothing ") + kSamplesFile + " " + kNothingFile);
}

std::vector<double> Helper::outputs(Index count) const {
  return child->ask("outputs " + std::to_string(count))["values"].get<std::vector<double>>();
}

std::vector<Helper> open_helpers(const std::filesystem::path& programs,
                                 const std::filesystem::path& folder, std::vector<Peer>& missing) {
  std::vector<Helper> helpers;
  for (const Library& library : kLibraries) {
    Peer peer;
    peer.name = library.name;
    const auto program = programs / (std::string("dcnn-peer-") + library.program);
    std::unique_ptr<Child> child;
    if (std::filesystem::exists(program)) {
      child = std::make_unique<Child>(program, folder);
      greet(*child, library, peer);
    } else {
      peer.missing = "no " + program.filename().string() +
                     " beside this program: tools/install-deps --peers, then build again";
    }
    if (peer.missing.empty()) {
      helpers.push_back({std::move(peer), library.reads_onnx, std::move(child)});
    } else {
      missing.push_back(std::move(peer));
    }
  }
  return helpers;
}

}  // namespace dcnn
