// SPDX-License-Identifier: Apache-2.0
// The folder of one training: configuration, metrics, best and last model, checkpoint; every file
// is replaced as a whole, so a kill at any moment leaves the last good state.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/file.h"
#include "dcnn/core/json.h"
#include "dcnn/models/container.h"
#include "dcnn/models/model.h"

namespace dcnn {

class RunDirectory {
 public:
  /// Makes the folder and locks it: a second training into it fails at once with Error(kUsage).
  explicit RunDirectory(std::filesystem::path folder);

  /// The checkpoint to go on from; none where there is none yet. `identity` names configuration and
  /// data: a checkpoint of another one is Error(kUsage).
  std::optional<Container> find_checkpoint(const std::string& identity) const;
  /// Starts anew: what an earlier training left is removed, the configuration written.
  void start(const Json& configuration);
  /// Keeps the metrics of the first `epochs` epochs, those the checkpoint knows.
  void keep_metrics(Index epochs);

  void save_checkpoint(Container file, const std::string& identity) const;
  void add_metrics(const EpochRecord& record);
  void save_model(const std::string& name, const Container& file) const;  ///< "best" or "last"

  const std::filesystem::path& folder() const { return folder_; }

 private:
  void write_metrics() const;

  std::filesystem::path folder_;
  FolderLock lock_;
  std::vector<std::string> metrics_;  // JSON lines, in order
};

}  // namespace dcnn
