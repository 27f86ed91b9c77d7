// From the simulator as given to a model that leaves nothing but noise, or as near as names go.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/scan.h"

namespace dcnn {

class Search {
 public:
  /// `progress` is told in words what is being done; it may be empty.
  Search(Case study, std::function<void(const std::string&)> progress);

  void run();

  const Case& study() const { return study_; }
  const JointFit& fit() const { return fit_; }
  const Setting& setting() const { return *setting_; }
  const std::vector<Floor>& floors() const { return floors_; }
  const Signals& left() const { return left_; }  ///< measured - predicted, at the log's rate
  /// chi-square of the simulator as given, in the final whitening.
  double chi2_before() const { return chi2_before_; }

  /// Whitens again for what these members leave, and fits them.
  void settle(const std::vector<Member>& members);
  /// The model without one member, the others refitted.
  JointFit without(std::size_t member) const;
  /// The best additions to a model, at most one per effect, refined, best first.
  std::vector<Trial> additions(const JointFit& fit) const;

 private:
  void choose_cutoff(const std::vector<Member>& members);
  void make_setting(const std::vector<Member>& members);
  bool grow();
  bool simplify();
  bool swap();
  bool replace_pairs();
  void say(const std::string& text) const;

  Case study_, softer_, harder_;  // the two others smooth more and less: what smoothing alone does
  std::function<void(const std::string&)> progress_;
  std::vector<Floor> floors_;
  std::unique_ptr<Setting> setting_;
  JointFit fit_;
  Signals left_;
  double chi2_before_ = 0.0;
};

/// measured - predicted per recording.
Signals difference(const Case& study, const Signals& prediction);

}  // namespace dcnn
