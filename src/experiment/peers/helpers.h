// SPDX-License-Identifier: Apache-2.0
// The helper programs of the libraries that are there.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dcnn/experiment/peers.h"
#include "experiment/peers/cases.h"
#include "experiment/peers/child.h"

namespace dcnn {

/// A folder of our own that is gone in the end.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  std::filesystem::path path;
};

/// A library whose helper answers.
struct Helper {
  Peer peer;
  bool reads_onnx;
  std::unique_ptr<Child> child;

  /// The case in its folder, at so many samples per call.
  void load(Index batch, int threads) const;
  /// The case in its folder as what does nothing.
  void load_nothing() const;
  /// Of the first `count` samples.
  std::vector<double> outputs(Index count) const;
};

/// Starts every helper in `programs`; the ones that cannot run are in `missing`.
std::vector<Helper> open_helpers(const std::filesystem::path& programs,
                                 const std::filesystem::path& folder, std::vector<Peer>& missing);

}  // namespace dcnn
