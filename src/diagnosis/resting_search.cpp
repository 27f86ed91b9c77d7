// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/resting_search.h"

#include "core/elementary.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/holdout.h"
#include "diagnosis/rest.h"

namespace dcnn {
namespace {

constexpr double kMostlyAtRest = 0.5;  // of the rows

std::unique_ptr<Search> run(Case study, const std::vector<Span>& held_out,
                            const std::function<void(const std::string&)>& progress) {
  auto search = std::make_unique<Search>(std::move(study), held_out, progress);
  search->run();
  return search;
}

}  // namespace

std::unique_ptr<Search> searched(LoadedCase& loaded, const std::vector<Span>& held_out,
                                 const std::function<void(const std::string&)>& progress) {
  if (share_within(loaded.fit, rests(loaded.fit)) <= kMostlyAtRest) {
    return run(std::move(loaded.fit), held_out, progress);
  }
  auto moving = run(loaded.fit, held_out, progress);
  const HoldOut holdout(moving->study(), loaded.holdout);
  if (holdout.empty()) return moving;
  if (!moving->remains() && !holdout.excess(*moving, holdout.floors(*moving))) return moving;
  if (progress) progress("searching where rows at rest count");
  loaded.fit.rests_count = true;
  loaded.fit.work = std::make_shared<Work>();
  loaded.fit.law_work = std::make_shared<Work>();
  auto all = run(loaded.fit, held_out, progress);
  // Each by its own smoother, on the rows that move.
  const HoldOut again(all->study(), loaded.holdout);
  const auto prediction = [](const HoldOut& held, const Search& search) {
    return held.prediction(search.fit().members, search.fit().base);
  };
  const double support =
      holdout.log_support(prediction(again, *all), prediction(holdout, *moving), moving->floors());
  if (support <= elementary::log(prior::kLikelier)) return moving;
  loaded.holdout.rests_count = true;
  return all;
}

}  // namespace dcnn
