// SPDX-License-Identifier: Apache-2.0
#include "experiment/run_directory.h"

#include <sstream>
#include <utility>

#include "dcnn/core/ranks.h"

namespace dcnn {
namespace {

constexpr std::size_t kMaxMetricsBytes = std::size_t{1} << 30;

}  // namespace

RunDirectory::RunDirectory(std::filesystem::path folder)
    : folder_(std::move(folder)), lock_(folder_) {}

std::optional<Container> RunDirectory::find_checkpoint(const std::string& identity) const {
  const auto path = folder_ / "checkpoint.safetensors";
  if (!std::filesystem::exists(path)) return std::nullopt;
  Container file = read_container(path);
  require(file.metadata["identity"] == identity, Exit::kUsage, path.string(),
          ": was made with another configuration, seed or other recordings; give the same ones, or "
          "leave "
          "--resume out to start anew");
  return file;
}

void RunDirectory::start(const Json& configuration) {
  if (!is_first_rank()) return;
  for (const char* name : {"checkpoint.safetensors", "metrics.jsonl", "best.dcnn", "last.dcnn"}) {
    std::error_code ignored;
    std::filesystem::remove(folder_ / name, ignored);
  }
  metrics_.clear();
  write_file(folder_ / "configuration.json", configuration.dump(2) + "\n");
}

void RunDirectory::keep_metrics(Index epochs) {
  const auto path = folder_ / "metrics.jsonl";
  metrics_.clear();
  if (!std::filesystem::exists(path)) return;
  std::istringstream lines(read_file(path, kMaxMetricsBytes, Exit::kFailure));
  for (std::string line;
       static_cast<Index>(metrics_.size()) < epochs && std::getline(lines, line);) {
    metrics_.push_back(line);
  }
}

void RunDirectory::save_checkpoint(Container file, const std::string& identity) const {
  file.metadata["identity"] = identity;
  write_container(folder_ / "checkpoint.safetensors", file);
}

void RunDirectory::add_metrics(const EpochRecord& record) {
  Json line = {{"epoch", record.epoch},
               {"loss", record.loss},
               {"learning_rate", record.rate},
               {"snr_db", record.snr_db ? Json(*record.snr_db) : Json()},
               {"validation_rmse", record.validation_rmse},
               {"best", record.best}};
  metrics_.push_back(line.dump());
  write_metrics();
}

void RunDirectory::save_model(const std::string& name, const Container& file) const {
  write_container(folder_ / (name + ".dcnn"), file);
}

void RunDirectory::write_metrics() const {
  std::string text;
  for (const auto& line : metrics_) text += line + "\n";
  write_file(folder_ / "metrics.jsonl", text);
}

}  // namespace dcnn
