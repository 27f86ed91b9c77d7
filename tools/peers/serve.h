// SPDX-License-Identifier: Apache-2.0
// What every helper dcnn-peer-<library> does between its library and dcnn-bench: the protocol of
// src/experiment/peers/child.h.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "dcnn/core/json.h"
#include "dcnn/core/tensor.h"
#include "dcnn/models/container.h"

namespace dcnn::peers {

/// A network as dcnn-bench exported it.
struct ExportedNetwork {
  Json layers;
  Shape input;
  bool carries;  ///< the state of an LSTM goes on from call to call
  Container file;

  /// A tensor of layer `layer`: weight, bias, …
  const StoredTensor& tensor(Index layer, const std::string& name) const;
  const float* values(Index layer, const std::string& name) const;
};

/// A network at a fixed number of samples per call.
class Runner {
 public:
  virtual ~Runner() = default;
  /// Outputs (batch, outputs) of samples (batch, input…), valid until the next call.
  virtual const float* run(const float* samples) = 0;
  virtual Index outputs() const = 0;
  /// From here on with no state.
  virtual void begin() {}
};

/// A network in training on data of its own.
class Trainee {
 public:
  virtual ~Trainee() = default;
  virtual void epoch() = 0;
};

struct Library {
  std::string name, version;
  std::function<std::unique_ptr<Runner>(const ExportedNetwork&, Index batch, int threads)> load;
  std::function<std::unique_ptr<Trainee>(const std::string& network, int threads)> train = {};
};

/// Answers lines of standard input until it ends. Returns the exit code.
int serve(const Library& library);

}  // namespace dcnn::peers
