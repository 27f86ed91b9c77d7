// SPDX-License-Identifier: Apache-2.0
// Tensor and reverse-mode differentiation.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

#ifdef DCNN_DOUBLE
using Real = double;  // the gradient tests: analytic and numeric gradients agree to 1e-7
#else
using Real = float;
#endif

/// Extents, outermost first. Images are channels-last: (N, H, W, C).
using Shape = std::vector<Index>;
Index element_count(const Shape& shape);
std::string to_string(const Shape& shape);  // "(50, 15, 5, 1)"

/// A shared handle to values, their gradient, and the operation they came from. Row-major, 64-byte
/// aligned.
class Tensor {
 public:
  Tensor() = default;
  /// Zeros. `wants_gradient` marks a leaf that is trained.
  explicit Tensor(Shape shape, bool wants_gradient = false);
  /// Values not yet set: for an operation that is about to write all of them.
  static Tensor uninitialised(Shape shape);
  static Tensor from(Shape shape, std::span<const Real> values, bool wants_gradient = false);

  bool defined() const { return node_ != nullptr; }
  const Shape& shape() const;
  Index dim(int axis) const;  // negative axes count from the end
  Index size() const;
  Real* data() const;
  std::span<Real> values() const;
  bool wants_gradient() const;
  /// dLoss/dthis: zeros at the first call after construction or clear_gradient().
  Real* gradient_data() const;
  std::span<Real> gradient() const;
  bool has_gradient() const;
  /// Where a backward pass writes: adds to what is there, or overwrites it all (saves filling with
  /// zeros).
  struct GradientSlot {
    Real* data;
    bool add;
  };
  GradientSlot gradient_slot() const;
  void clear_gradient() const;

  /// The same values under another shape of the same size; gradients flow through.
  Tensor reshaped(Shape shape) const;

  /// Fills the gradients of everything this scalar was computed from, then frees the record.
  void backward() const;

 private:
  struct Node;
  explicit Tensor(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  friend Tensor record(Tensor, std::vector<Tensor>, std::function<void(const Tensor&)>);
  std::shared_ptr<Node> node_;
};

/// Says how `out` was made: `backward(out)` adds to the gradients of those inputs that want one,
/// given out.gradient(). Does nothing where no input wants a gradient or a NoGradient guard is
/// alive.
Tensor record(Tensor out, std::vector<Tensor> inputs,
              std::function<void(const Tensor& out)> backward);

/// While alive, this thread records nothing (prediction).
class NoGradient {
 public:
  NoGradient();
  ~NoGradient();
  NoGradient(const NoGradient&) = delete;
  NoGradient& operator=(const NoGradient&) = delete;

 private:
  bool before_;
};

/// While alive, this thread keeps the memory of tensors that are gone for tensors of the same size:
/// every step of a training asks for the same ones, and the system clears what it is given back.
class KeptMemory {
 public:
  KeptMemory();
  ~KeptMemory();
  KeptMemory(const KeptMemory&) = delete;
  KeptMemory& operator=(const KeptMemory&) = delete;

 private:
  bool outermost_;
};

/// Whether record() would do anything here: an operation that no one will ask for a gradient need
/// not keep what its backward pass reads.
bool recording(std::initializer_list<Tensor> inputs);

}  // namespace dcnn
