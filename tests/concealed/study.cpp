// dcnn_concealed SEED FOLDER ID...: diagnoses concealed scenarios one by one. Appends a line of
// JSON per scenario to FOLDER/results.jsonl and skips those already there.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <set>

#include "dcnn/conceal/scenario.h"
#include "dcnn/diagnosis/diagnose.h"

using namespace dcnn;

namespace {

std::set<std::string> done(const std::filesystem::path& results) {
  std::set<std::string> ids;
  std::ifstream in(results);
  for (std::string line; std::getline(in, line);) ids.insert(Json::parse(line)["id"]);
  return ids;
}

Json names_of(const Json& findings) {
  Json names = Json::array();
  for (const Json& f : findings) names.push_back(f["effect"]);
  return names;
}

/// Hidden effects that are named, or alternatives of a name that is left; and names that are
/// neither.
void score(const conceal::Scenario& s, const Json& findings, Json& line) {
  std::vector<bool> used(findings.size(), false);
  int top = 0, in_class = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (const auto& h : s.hidden) {
      bool named = false;
      for (const Json& f : findings) named = named || f["effect"] == h.effect;
      if (named != (pass == 0)) continue;
      for (std::size_t k = 0; k < findings.size(); ++k) {
        const Json others = findings[k].value("alternatives", Json::array());
        const bool listed = std::find(others.begin(), others.end(), h.effect) != others.end();
        if (used[k] || !(findings[k]["effect"] == h.effect || (pass == 1 && listed))) continue;
        used[k] = true;
        ++in_class;
        top += pass == 0;
        break;
      }
    }
  }
  const int wanted = static_cast<int>(s.hidden.size()), said = static_cast<int>(findings.size());
  line["top"] = top;
  line["class"] = in_class;
  line["wanted"] = wanted;
  line["named"] = said;
  line["false_names"] = said - in_class;
  line["exact"] = in_class == wanted && said == wanted;
}

Json run(const std::string& id, std::uint64_t seed, const std::filesystem::path& folder) {
  const conceal::Scenario s = conceal::draw(id, seed);
  const conceal::Files files = conceal::write(s, folder / "scenario");
  DiagnosisRequest request;
  request.simulator = files.simulator;
  request.fit = files.fit;
  request.holdout = files.holdout;
  const auto begin = std::chrono::steady_clock::now();
  const Json report = diagnose(request, [](const std::string&) {});
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
  Json line{{"id", id}, {"seed", seed}, {"group", s.group}, {"motion", s.motion}};
  line["sigma"] = s.noise.sigma;
  line["truth"] = conceal::truth(s);
  for (const char* key : {"findings", "verdict", "fit", "chi2_before", "chi2", "rows"}) {
    line[key] = report.value(key, Json());
  }
  const Json findings = report.value("findings", Json::array());
  score(s, findings, line);
  line["seconds"] = spent.count();
  std::printf("%s %s hidden %s said %s chi2 %s -> %s (%.1f s)\n", line["exact"] ? "ok  " : "MISS",
              id.c_str(), names_of(line["truth"]).dump().c_str(), names_of(findings).dump().c_str(),
              line["chi2_before"].dump().c_str(), line["chi2"].dump().c_str(), spent.count());
  std::fflush(stdout);
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4)
    return std::fputs("dcnn_concealed SEED FOLDER group:value/effect/number...\n", stderr), 2;
  const std::filesystem::path folder = argv[2], results = folder / "results.jsonl";
  std::filesystem::create_directories(folder);
  const std::set<std::string> skip = done(results);
  for (int k = 3; k < argc; ++k) {
    if (skip.count(argv[k])) continue;
    try {
      std::ofstream(results, std::ios::app)
          << run(argv[k], std::stoull(argv[1]), folder).dump() << "\n";
    } catch (const std::exception& e) {
      std::printf("FAIL %s: %s\n", argv[k], e.what());
    }
  }
}
