#include "dcnn/conceal/scenario.h"
#include "dcnn/core/file.h"
#include "dcnn/data/csv.h"

namespace dcnn::conceal {

Files write(const Scenario& s, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  Files files;
  files.simulator = folder / "sim.json";
  Json sim;
  sim["tool"]["mass_kg"] = s.tool.mass;
  sim["tool"]["com_m"] = {s.tool.com(0), s.tool.com(1), s.tool.com(2)};
  sim["gravity_mps2"] = {0.0, 0.0, -9.81};
  sim["sensor"]["bias_n"] = {s.tool.bias(0), s.tool.bias(1), s.tool.bias(2)};
  sim["sample_rate_hz"] = 500;
  write_file(files.simulator, sim.dump(2) + "\n");
  for (const Recorded& r : s.recordings) {
    Table table{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"}, {}};
    table.values.resize(r.t.size(), 10);
    table.values << r.t, r.pose, r.measured;
    (r.holdout ? files.holdout : files.fit).push_back(folder / (r.name + ".csv"));
    write_csv(folder / (r.name + ".csv"), table);
  }
  return files;
}

Json truth(const Scenario& s) {
  Json all = Json::array();
  for (const Hidden& h : s.hidden) {
    Json one;
    one["effect"] = h.effect;
    one["axis"] = h.axis.empty() ? Json() : Json(h.axis);
    one["interval_s"] = h.interval_s ? Json{h.interval_s->first, h.interval_s->second} : Json();
    for (const auto& [name, value] : h.parameters) one["parameters"][name] = value;
    all.push_back(one);
  }
  return all;
}

}  // namespace dcnn::conceal
