#include "support/file_kind.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include "dcnn/core/file.h"
#include "dcnn/core/json.h"

namespace dcnn {
namespace {

struct KindWords {
  FileKind kind;
  const char *is, *use;
};

constexpr std::array kKindWords{
    KindWords{FileKind::kModel, "a trained model",
              "dcnn-eval, dcnn-predict, dcnn-bench and dcnn-run --model take it"},
    KindWords{FileKind::kSimulator, "a simulator",
              "dcnn-sim --sim with --motion, dcnn-diagnose --sim and dcnn-predict take it"},
    KindWords{FileKind::kScene, "a scene to simulate", "dcnn-sim --config takes it"},
    KindWords{FileKind::kTruth, "the truth behind simulated recordings", "no program reads it"},
    KindWords{FileKind::kSystem, "a description of a machine",
              "dcnn-train and dcnn-diagnose take it as --system"},
    KindWords{FileKind::kCalibration, "a calibration",
              "dcnn-run and dcnn-teleop take it as --calibration"},
    KindWords{FileKind::kTeleop, "a configuration of the teleoperation",
              "dcnn-teleop --config takes it"},
    KindWords{FileKind::kReport, "a report", "its page is the report.html beside it"},
    KindWords{FileKind::kTraining, "a configuration of a training", "dcnn-train --config takes it"},
    KindWords{FileKind::kRecording, "a recording (CSV)",
              "options such as --data, --train and --fit take it"},
};

const KindWords* words_of(FileKind kind) {
  const auto* found = std::find_if(kKindWords.begin(), kKindWords.end(),
                                   [=](const KindWords& words) { return words.kind == kind; });
  return found == kKindWords.end() ? nullptr : found;
}

FileKind kind_of_json(const Json& json) {
  if (!json.is_object()) return FileKind::kUnknown;
  const auto has = [&](const char* key) { return json.contains(key); };
  if (has("kind") && json["kind"].is_string()) return FileKind::kSystem;
  if (has("rotation_es")) return FileKind::kCalibration;
  if (has("verdict") || (has("summary") && has("rows"))) return FileKind::kReport;
  if (has("simulator") && has("recordings"))
    return has("effects") ? FileKind::kTruth : FileKind::kScene;
  if (has("master") || has("slave") || has("wall")) return FileKind::kTeleop;
  if (has("tool")) return FileKind::kSimulator;
  if (has("preset") || has("training") || has("features")) return FileKind::kTraining;
  return FileKind::kUnknown;
}

/// A first line of several names, as recordings have.
bool is_header(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.find(',') != line.npos && std::none_of(line.begin(), line.end(), [](char c) {
           return c == '{' || c == '\0' || static_cast<unsigned char>(c) >= 0x80U;
         });
}

}  // namespace

FileKind kind_of_file(const std::filesystem::path& file) {
  constexpr std::size_t kMostJson = std::size_t{1} << 20;
  std::error_code missing;
  if (!std::filesystem::is_regular_file(file, missing)) return FileKind::kUnknown;
  std::array<char, 512> bytes{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), bytes.size());
  const std::string text(bytes.data(), static_cast<std::size_t>(stream.gcount()));
  if (text.size() > 9 && text[8] == '{' && text[7] == '\0') return FileKind::kModel;
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos || text[first] != '{') {
    return is_header(text) ? FileKind::kRecording : FileKind::kUnknown;
  }
  if (std::filesystem::file_size(file, missing) > kMostJson) return FileKind::kUnknown;
  try {
    return kind_of_json(read_json(file, Exit::kData));
  } catch (const Error&) {
    return FileKind::kUnknown;
  }
}

namespace {

/// The exit code where a file of this kind is needed and another one is given.
Exit exit_without(FileKind wanted) {
  switch (wanted) {
    case FileKind::kModel:
      return Exit::kModel;
    case FileKind::kScene:
    case FileKind::kTraining:
    case FileKind::kTeleop:
      return Exit::kUsage;
    default:
      return Exit::kData;
  }
}

}  // namespace

void expect_kind(const std::string& place, const std::filesystem::path& file,
                 std::initializer_list<FileKind> wanted) {
  const FileKind kind = kind_of_file(file);
  const KindWords* is = words_of(kind);
  if (!is || std::find(wanted.begin(), wanted.end(), kind) != wanted.end()) return;
  std::string list;
  for (const FileKind one : wanted) {
    list += (list.empty() ? "" : " or ") + std::string(words_of(one)->is);
  }
  fail(exit_without(*wanted.begin()), file.string(), ": is ", is->is, "; ", place, " needs ", list,
       " (", is->use, ")");
}

}  // namespace dcnn
