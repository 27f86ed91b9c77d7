// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/tensor.h"

#include <algorithm>
#include <cassert>
#include <new>
#include <unordered_map>
#include <unordered_set>

namespace dcnn {
namespace {

constexpr std::align_val_t kAlignment{64};  // a cache line and the widest vector

thread_local bool no_gradient = false;

/// Blocks of memory by their number of values; null where none are kept.
using Spares = std::unordered_map<Index, std::vector<Real*>>;
thread_local Spares* spares = nullptr;

Real* take_memory(Index size) {
  if (spares) {
    std::vector<Real*>& fitting = (*spares)[size];
    if (!fitting.empty()) {
      Real* block = fitting.back();
      fitting.pop_back();
      return block;
    }
  }
  const auto bytes = static_cast<std::size_t>(size) * sizeof(Real);
  return static_cast<Real*>(::operator new(bytes, kAlignment));
}

void give_memory(Real* block, Index size) {
  if (spares) {
    (*spares)[size].push_back(block);
  } else {
    ::operator delete(block, kAlignment);
  }
}
thread_local std::uint64_t last_order = 0;

}  // namespace

Index element_count(const Shape& shape) {
  Index count = 1;
  for (const Index extent : shape) count *= extent;
  return count;
}

std::string to_string(const Shape& shape) {
  std::string text = "(";
  for (const Index extent : shape) text += (text.size() > 1 ? ", " : "") + std::to_string(extent);
  return text + ")";
}

/// Values and their gradient, shared by a tensor and its reshaped views.
struct Buffer {
  struct Give {
    Index size;
    void operator()(Real* data) const { give_memory(data, size); }
  };
  using Storage = std::unique_ptr<Real[], Give>;

  static Storage allocate(Index size) { return Storage(take_memory(size), Give{size}); }

  Index size = 0;
  Storage values{nullptr, Give{0}}, gradient{nullptr, Give{0}};
  bool has_gradient = false;
};

struct Tensor::Node {
  Shape shape;
  std::shared_ptr<Buffer> buffer;
  bool wants_gradient = false;
  std::uint64_t order = 0;  // rises with every recorded operation: a topological order for free
  std::vector<Tensor> inputs;
  std::function<void(const Tensor&)> backward;

  Node(Shape its_shape, std::shared_ptr<Buffer> its_buffer)
      : shape(std::move(its_shape)), buffer(std::move(its_buffer)) {}
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  ~Node() { release(); }

  /// Forgets how this was made. Frees a chain of any length without recursing along it.
  void release() {
    std::vector<Tensor> doomed = std::move(inputs);
    inputs.clear();
    backward = nullptr;  // its captures are among the inputs, which `doomed` still holds
    while (!doomed.empty()) {
      const Tensor tensor = std::move(doomed.back());
      doomed.pop_back();
      if (!tensor.defined() || tensor.node_.use_count() > 1) continue;
      auto& next = tensor.node_->inputs;
      doomed.insert(doomed.end(), next.begin(), next.end());
      next.clear();
      tensor.node_->backward = nullptr;
    }
  }
};

Tensor Tensor::uninitialised(Shape shape) {
  auto buffer = std::make_shared<Buffer>();
  buffer->size = element_count(shape);
  buffer->values = Buffer::allocate(buffer->size);
  return Tensor(std::make_shared<Node>(std::move(shape), std::move(buffer)));
}

Tensor::Tensor(Shape shape, bool wants_gradient) : Tensor(uninitialised(std::move(shape))) {
  std::fill_n(data(), size(), Real(0));
  node_->wants_gradient = wants_gradient;
}

Tensor Tensor::from(Shape shape, std::span<const Real> values, bool wants_gradient) {
  Tensor tensor = uninitialised(std::move(shape));
  assert(static_cast<Index>(values.size()) == tensor.size());
  std::copy(values.begin(), values.end(), tensor.data());
  tensor.node_->wants_gradient = wants_gradient;
  return tensor;
}

const Shape& Tensor::shape() const { return node_->shape; }

Index Tensor::dim(int axis) const {
  const int rank = static_cast<int>(shape().size());
  return shape().at(static_cast<std::size_t>(axis < 0 ? axis + rank : axis));
}

Index Tensor::size() const { return node_->buffer->size; }
Real* Tensor::data() const { return node_->buffer->values.get(); }
std::span<Real> Tensor::values() const { return {data(), static_cast<std::size_t>(size())}; }
bool Tensor::wants_gradient() const { return node_->wants_gradient; }
bool Tensor::has_gradient() const { return node_->buffer->has_gradient; }
void Tensor::clear_gradient() const { node_->buffer->has_gradient = false; }

Tensor::GradientSlot Tensor::gradient_slot() const {
  Buffer& buffer = *node_->buffer;
  if (!buffer.gradient) buffer.gradient = Buffer::allocate(buffer.size);
  return {buffer.gradient.get(), std::exchange(buffer.has_gradient, true)};
}

Real* Tensor::gradient_data() const {
  const GradientSlot slot = gradient_slot();
  if (!slot.add) std::fill_n(slot.data, size(), Real(0));
  return slot.data;
}

std::span<Real> Tensor::gradient() const {
  return {gradient_data(), static_cast<std::size_t>(size())};
}

Tensor Tensor::reshaped(Shape shape) const {
  assert(element_count(shape) == size());
  Tensor view(std::make_shared<Node>(std::move(shape), node_->buffer));
  return record(view, {*this}, [](const Tensor&) {});  // they share the gradient's memory
}

void Tensor::backward() const {
  assert(size() == 1);
  gradient()[0] = 1;
  std::vector<Tensor> graph{*this};
  std::unordered_set<const Node*> seen{node_.get()};
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const Node& node = *graph[i].node_;
    for (const Tensor& input : node.inputs) {
      if (input.node_->backward && seen.insert(input.node_.get()).second) graph.push_back(input);
    }
  }
  std::sort(graph.begin(), graph.end(),
            [](const Tensor& a, const Tensor& b) { return a.node_->order < b.node_->order; });
  while (!graph.empty()) {  // newest first; memory goes back as soon as it is used up
    const Tensor tensor = std::move(graph.back());
    graph.pop_back();
    if (tensor.node_->backward && tensor.has_gradient()) tensor.node_->backward(tensor);
    tensor.node_->release();
  }
}

Tensor record(Tensor out, std::vector<Tensor> inputs,
              std::function<void(const Tensor& out)> backward) {
  const bool wanted = std::any_of(inputs.begin(), inputs.end(),
                                  [](const Tensor& input) { return input.wants_gradient(); });
  if (no_gradient || !wanted) return out;
  out.node_->wants_gradient = true;
  out.node_->order = ++last_order;
  out.node_->inputs = std::move(inputs);
  out.node_->backward = std::move(backward);
  return out;
}

bool recording(std::initializer_list<Tensor> inputs) {
  return !no_gradient && std::any_of(inputs.begin(), inputs.end(),
                                     [](const Tensor& input) { return input.wants_gradient(); });
}

KeptMemory::KeptMemory() : outermost_(spares == nullptr) {
  if (outermost_) spares = new Spares;
}

KeptMemory::~KeptMemory() {
  if (!outermost_) return;
  const std::unique_ptr<Spares> kept(std::exchange(spares, nullptr));
  for (const auto& [size, blocks] : *kept) {
    for (Real* block : blocks) give_memory(block, size);
  }
}

NoGradient::NoGradient() : before_(no_gradient) { no_gradient = true; }
NoGradient::~NoGradient() { no_gradient = before_; }

}  // namespace dcnn
