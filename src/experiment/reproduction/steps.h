// The steps of a reproduction, from data to numbers; the report reads what they write.
#pragma once

#include <string>
#include <vector>

#include "experiment/reproduction/layout.h"
#include "experiment/reproduction/ledger.h"
#include "experiment/reproduction/plan.h"

namespace dcnn {

class Workshop {
 public:
  Workshop(const ReproductionRequest& request, const ReproductionPlan& plan);

  std::vector<Step> steps();
  std::filesystem::path training_data() const;
  std::filesystem::path test_data() const;
  /// SHA-256 of the file, read once.
  const std::string& data_hash(const std::filesystem::path& file);

 private:
  struct Training {
    std::string series;  ///< folder: a protocol, or a further training
    const Entry* entry;
    Json noise;
    std::uint64_t seed;
    std::optional<Index> epochs;
  };

  Step simulation();
  Step training(const Training& what);
  Step scoring(const NoiseMode& mode, const Training& what);
  Step timing(const Entry& entry);
  Training further(const Entry& entry, int k) const;

  Json features_of(const Entry& entry) const;
  Json configuration(const Training& what) const;
  std::string training_inputs(const Training& what);
  std::string code() const;

  const ReproductionRequest& request_;
  const ReproductionPlan& plan_;
  OutputLayout layout_;
  std::vector<std::pair<std::filesystem::path, std::string>> hashes_;
};

}  // namespace dcnn
