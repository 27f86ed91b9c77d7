// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/layer.h"
#include "nn/kernels/elementwise.h"
#include "nn/pieces.h"

namespace dcnn {
namespace {

/// In training y = x·mask/(1 - rate) with mask = 0 at the given rate, else y = x (Srivastava et al.
/// 2014, inverted scaling). Two values share one hash: 32 random bits each.
class Dropout final : public Layer {
 public:
  explicit Dropout(double rate) : rate_(rate) {}

  Tensor forward(const Tensor& x, Pass& pass) const override {
    if (pass.mode != Pass::Mode::kTrain || rate_ == 0) return x;
    const std::uint64_t key = pass.rng.bits();
    Tensor mask = Tensor::uninitialised(x.shape()), y = Tensor::uninitialised(x.shape());
    for_each_range(x, [&](Index begin, Index count) {
      draw(key, begin, count, mask.data());
      multiply(x.data() + begin, mask.data() + begin, count, {y.data() + begin, false});
    });
    return record(y, {x}, [x, mask](const Tensor& out) {
      const Tensor::GradientSlot dx = x.gradient_slot();
      const Real* dy = out.gradient_data();
      for_each_range(x, [&](Index begin, Index count) {
        multiply(dy + begin, mask.data() + begin, count, {dx.data + begin, dx.add});
      });
    });
  }

  std::unique_ptr<PlanStep> plan(const Shape&, PlanStep*) const override { return nullptr; }

 private:
  void draw(std::uint64_t key, Index begin, Index count, Real* mask) const {
    const auto key_of = [&](Index pair) { return key + static_cast<std::uint64_t>(pair); };
    const auto drop_below = static_cast<std::uint32_t>(rate_ * 0x1p32);
    const auto kept = static_cast<Real>(1 / (1 - rate_));
    const auto one = [&](Index i) {  // whose neighbour is another piece's
      Real both[2];
      dropout_mask({key_of(i / 2), drop_below, kept}, 1, both);
      mask[i] = both[i % 2];
    };
    const Index end = begin + count, first = (begin + 1) / 2, last = std::max(first, end / 2);
    if (begin % 2 != 0 && count > 0) one(begin);
    dropout_mask({key_of(first), drop_below, kept}, last - first, mask + 2 * first);
    if (end % 2 != 0 && end > 2 * first) one(end - 1);
  }

  double rate_;
};

LayerPtr make_dropout(Options& options, const Shape&, Rng&) {
  return std::make_unique<Dropout>(options.number("rate", 0.5, 0.0, 0.99));
}

}  // namespace

extern constinit const LayerKind dropout{.name = "dropout",
                                         .example = R"({"rate": 0.3})",
                                         .example_input = {3, 5, 4},
                                         .make = make_dropout};

}  // namespace dcnn
