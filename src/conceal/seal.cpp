// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "dcnn/conceal/challenge.h"
#include "dcnn/conceal/scenario.h"
#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"

namespace dcnn::conceal {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kLargest = std::size_t{1} << 30;

std::string digest_of(const fs::path& file) {
  return sha256_hex({read_file(file, kLargest, Exit::kData)});
}

void keep_apart(const fs::path& folder, const fs::path& seal) {
  const fs::path inside =
      fs::weakly_canonical(seal).lexically_relative(fs::weakly_canonical(folder));
  require(inside.empty() || *inside.begin() == "..", Exit::kUsage, seal.string(),
          ": the answers may not lie in the folder of the recordings; name a file elsewhere");
}

Json written(const Scenario& scenario, const fs::path& folder) {
  const Files files = write(scenario, folder);
  Json digests{{"sim.json", digest_of(files.simulator)}};
  for (const auto* list : {&files.fit, &files.holdout}) {
    for (const fs::path& file : *list) digests[file.filename().string()] = digest_of(file);
  }
  return digests;
}

}  // namespace

std::string write_seal(const Json& answers, const fs::path& folder, const fs::path& seal) {
  keep_apart(folder, seal);
  const std::string bytes = answers.dump(1) + "\n", digest = sha256_hex({bytes});
  FileSet files(folder);
  write_file(seal, bytes);
  write_file(folder / "seal.sha256", digest + "  " + seal.filename().string() + "\n");
  files.commit();
  return digest;
}

std::string seal_each(const std::vector<std::string>& ids, std::uint64_t seed,
                      const fs::path& folder, const fs::path& seal,
                      const std::function<void(int, int)>& progress, const WriteScenario& write) {
  keep_apart(folder, seal);
  FileSet files(folder);  // recordings, their seal and its digest belong together
  for (const char* earlier : {"sim.json", "system.json", "fit_*.csv", "holdout_*.csv"}) {
    files.replaces(std::string("s[0-9][0-9][0-9][0-9]/") + earlier);
  }
  Json answers{{"seed", seed}, {"scenarios", Json::array()}};
  for (std::size_t k = 0; k < ids.size(); ++k) {
    char name[32];
    std::snprintf(name, sizeof name, "s%04zu", k + 1);
    Json one{{"id", name}};
    one.update(write(ids[k], folder / name));
    answers["scenarios"].push_back(one);
    progress(static_cast<int>(k) + 1, static_cast<int>(ids.size()));
  }
  const std::string digest = write_seal(answers, folder, seal);
  files.commit();
  return digest;
}

std::string conceal_challenge(const std::vector<std::string>& ids, std::uint64_t seed,
                              const fs::path& folder, const fs::path& seal,
                              const std::function<void(int, int)>& progress,
                              const std::vector<Recording>& motions) {
  return seal_each(ids, seed, folder, seal, progress, [&](const auto& id, const auto& place) {
    Scenario scenario = draw(id, seed);
    for (const Recording& motion : motions) record_on(scenario, motion, seed);
    Json answer = truth(scenario);
    answer["sha256"] = written(scenario, place);
    return answer;
  });
}

Json open_seal(const fs::path& folder, const fs::path& seal) {
  const std::string bytes = read_file(seal, kLargest, Exit::kData);
  const std::string stored = read_file(folder / "seal.sha256", 4096, Exit::kData);
  require(stored.substr(0, 64) == sha256_hex({bytes}), Exit::kData, seal.string(),
          ": its SHA-256 is not the one in ", (folder / "seal.sha256").string(),
          "; the answers were changed after they were sealed: make the challenge anew");
  return parse_json(bytes, seal.string(), Exit::kData);
}

}  // namespace dcnn::conceal
