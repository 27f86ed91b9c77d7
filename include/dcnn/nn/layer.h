// SPDX-License-Identifier: Apache-2.0
// Layers hold parameters and no mood: training and randomness arrive with the call.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "dcnn/core/options.h"
#include "dcnn/core/random.h"
#include "dcnn/core/tensor.h"
#include "dcnn/nn/plan.h"

namespace dcnn {

/// What a forward pass is for.
struct Pass {
  enum class Mode {
    kInfer,    ///< dropout is the identity, batch norm uses its stored statistics
    kTrain,    ///< dropout draws, batch norm uses the batch and updates running statistics
    kCollect,  ///< no dropout; batch norm uses the batch and pools its statistics over batches
               ///< (Ioffe and Szegedy 2015)
  };
  Mode mode = Mode::kInfer;
  Rng rng{0};              ///< dropout draws one key per call from it, so threads do not matter
  Index batch_number = 0;  ///< kCollect: 0 for the first batch of the pass
};

/// A tensor by name, and how the optimiser treats it.
struct NamedTensor {
  enum class Role {
    kWeight,     ///< trained, L2 applies (weights, batch norm's gamma and beta)
    kBias,       ///< trained, no L2
    kStatistic,  ///< not trained: running mean and variance
  };
  std::string name;
  Tensor tensor;
  Role role;
};

class Normalisation;

class Layer {
 public:
  virtual ~Layer() = default;
  virtual Tensor forward(const Tensor& x, Pass& pass) const = 0;
  /// Lets the layer before do in forward() what this one does; false where that cannot.
  virtual bool join(Layer& /*before*/) const { return false; }
  /// From now on forward() does a batch norm or a ReLU, too; false where it cannot.
  virtual bool absorb_norm(const Normalisation& /*norm*/) { return false; }
  virtual bool absorb_relu() { return false; }
  /// Whether a piece of a batch passes forth and back without the others, but for PieceSums: then
  /// processes can divide its pieces.
  virtual bool is_divisible() const { return true; }
  /// The layer at inference as a step for one sample of this shape, given the step before it (null
  /// for the first); null where it does nothing then, or where that step does it too.
  virtual std::unique_ptr<PlanStep> plan(const Shape& sample, PlanStep* before) const = 0;
  /// Trained weights and stored statistics: what a model file holds.
  virtual std::vector<NamedTensor> state() const { return {}; }
};

using LayerPtr = std::unique_ptr<Layer>;

/// One row of the list of layers (layers.def): how it is named, made and tested.
struct LayerKind {
  const char* name;
  const char* example;                         ///< options for the shared tests, JSON
  std::initializer_list<Index> example_input;  ///< (N, …)
  /// `input` is the shape of one sample, without N.
  LayerPtr (*make)(Options&, const Shape& input, Rng&);
};

/// All kinds, in the order of layers.def.
std::vector<const LayerKind*> layer_kinds();

}  // namespace dcnn
