// SPDX-License-Identifier: Apache-2.0
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
  const char *is, *use, *source;  ///< its name, who takes it, where one comes from
};

constexpr std::array kKindWords{
    KindWords{FileKind::kModel, "a trained model",
              "dcnn-eval, dcnn-predict, dcnn-bench and dcnn-run --model take it",
              "dcnn-train writes it"},
    KindWords{FileKind::kSimulator, "a simulator of a tool on a wrist sensor",
              "dcnn-sim --sim with --motion, dcnn-diagnose --sim and dcnn-predict take it",
              "sim.json of dcnn-identify or dcnn-sim --config, model.json of dcnn-diagnose"},
    KindWords{FileKind::kMachine, "a corrected simulator of a machine",
              "dcnn-forward, dcnn-sim --sim with --motion and dcnn-predict take it",
              "model.json of dcnn-diagnose --system"},
    KindWords{FileKind::kScene, "a scene to simulate", "dcnn-sim --config takes it",
              "such as configs/sim/sample.json"},
    KindWords{FileKind::kTruth, "the truth behind simulated recordings", "no program reads it",
              "truth.json of dcnn-sim --config"},
    KindWords{FileKind::kSystem, "a description of a machine",
              "dcnn-train and dcnn-diagnose take it as --system",
              "such as configs/systems/panda.json"},
    KindWords{FileKind::kCalibration, "a calibration",
              "dcnn-run and dcnn-teleop take it as --calibration", "dcnn-calibrate writes it"},
    KindWords{FileKind::kTeleop, "a configuration of the teleoperation",
              "dcnn-teleop --config takes it", "such as configs/teleop.json"},
    KindWords{FileKind::kReport, "a report", "its page is the report.html beside it",
              "dcnn-diagnose and others write it"},
    KindWords{FileKind::kTraining, "a configuration of a training", "dcnn-train --config takes it",
              "such as configs/ntnu_wrist.json"},
    KindWords{FileKind::kLimits, "the limits of a robot", "dcnn-design --limits takes it",
              "such as configs/limits/wrist.json"},
    KindWords{FileKind::kRecipe, "the recipe of an import", "--recipe takes it",
              "import.json of dcnn-import"},
    KindWords{FileKind::kSweep, "a description of cells", "dcnn-sweep takes it",
              "commands and what they run over, docs/use/cluster.md"},
    KindWords{FileKind::kRecording, "a recording",
              "options such as --data, --train and --fit take it",
              "CSV: a header row, then one row per sample"},
    KindWords{FileKind::kJson, "JSON", "no option takes it for anything else", ""},
};

const KindWords* words_of(FileKind kind) {
  const auto* found = std::find_if(kKindWords.begin(), kKindWords.end(),
                                   [=](const KindWords& words) { return words.kind == kind; });
  return found == kKindWords.end() ? nullptr : found;
}

FileKind kind_of_json(const Json& json) {
  if (!json.is_object()) return FileKind::kJson;
  const auto has = [&](const char* key) { return json.contains(key); };
  if (has("system") && has("axes")) return FileKind::kMachine;
  if (has("kind") && json["kind"].is_string()) return FileKind::kSystem;
  if (has("rotation_es")) return FileKind::kCalibration;
  if (has("verdict") || (has("summary") && has("rows"))) return FileKind::kReport;
  if (has("simulator") && has("recordings"))
    return has("effects") ? FileKind::kTruth : FileKind::kScene;
  if (has("master") || has("slave") || has("wall")) return FileKind::kTeleop;
  if (has("import")) return FileKind::kRecipe;
  if (has("commands") || has("cells")) return FileKind::kSweep;
  if (has("position_m") || has("speed_mps")) return FileKind::kLimits;
  if (has("tool")) {
    return json["tool"].is_object() && json["tool"].contains("tool") ? FileKind::kTeleop
                                                                     : FileKind::kSimulator;
  }
  if (has("preset") || has("training") || has("features")) return FileKind::kTraining;
  return FileKind::kJson;
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
  if (first == text.npos) return FileKind::kUnknown;
  if (text[first] != '{' && text[first] != '[') {
    return is_header(text) ? FileKind::kRecording : FileKind::kUnknown;
  }
  if (std::filesystem::file_size(file, missing) > kMostJson) return FileKind::kUnknown;
  try {
    return kind_of_json(read_json(file, Exit::kData));
  } catch (const Error&) {
    return FileKind::kJson;
  }
}

namespace {

/// The exit code where a file of this kind is needed and another one is given.
Exit exit_without(FileKind wanted) {
  switch (wanted) {
    case FileKind::kModel:
    case FileKind::kMachine:
      return Exit::kModel;
    case FileKind::kScene:
    case FileKind::kTraining:
    case FileKind::kTeleop:
    case FileKind::kLimits:
    case FileKind::kRecipe:
    case FileKind::kSweep:
      return Exit::kUsage;
    default:
      return Exit::kData;
  }
}

/// Of the kinds that an option takes the one that an absent file was meant to be, by its name.
FileKind meant(const std::vector<FileKind>& wanted, const std::filesystem::path& file) {
  if (file.extension() != ".json") return wanted.front();
  const auto document = std::find_if(wanted.begin(), wanted.end(),
                                     [](FileKind kind) { return kind != FileKind::kModel; });
  return document == wanted.end() ? wanted.front() : *document;
}

bool has(const std::vector<FileKind>& kinds, FileKind kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

/// "a trained model (dcnn-train writes it) or a calibration (…)".
std::string list_of(const std::vector<FileKind>& wanted) {
  std::string list;
  for (const FileKind one : wanted) {
    const KindWords& words = *words_of(one);
    list += (list.empty() ? "" : " or ") + std::string(words.is) + " (" + words.source + ")";
  }
  return list;
}

}  // namespace

void expect_file(const std::string& place, const std::filesystem::path& file,
                 const std::vector<FileKind>& wanted) {
  if (file == "-" || has(wanted, FileKind::kRecording)) return;
  std::error_code error;
  const char* is = !std::filesystem::exists(file, error)        ? ": does not exist; "
                   : std::filesystem::is_directory(file, error) ? ": is a folder; "
                                                                : nullptr;
  if (is != nullptr) {
    fail(exit_without(meant(wanted, file)), file.string(), is, place, " needs ", list_of(wanted));
  }
}

void expect_kind(const std::string& place, const std::filesystem::path& file,
                 const std::vector<FileKind>& wanted) {
  const FileKind kind = kind_of_file(file);
  const bool reader_knows =
      kind == FileKind::kJson && std::any_of(wanted.begin(), wanted.end(), [](FileKind one) {
        return one != FileKind::kRecording && one != FileKind::kModel;
      });
  if (kind == FileKind::kUnknown || reader_knows || has(wanted, kind)) return;
  const KindWords& is = *words_of(kind);
  fail(exit_without(wanted.front()), file.string(), ": is ", is.is, " (", is.use, "); ", place,
       " needs ", list_of(wanted));
}

}  // namespace dcnn
