// SPDX-License-Identifier: Apache-2.0
// JSON documents: the first byte chooses what reads it.
#include "dcnn/calibration/calibration.h"
#include "dcnn/data/features.h"
#include "dcnn/data/input_map.h"
#include "dcnn/design/limits.h"
#include "dcnn/experiment/configuration.h"
#include "dcnn/import/recipe.h"
#include "dcnn/models/online_limits.h"
#include "dcnn/physics/chain.h"
#include "dcnn/physics/simulator.h"
#include "dcnn/teleop/teleop.h"
#include "fuzz/support.h"

using namespace dcnn;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = fuzz::text_of(data + 1, size - 1);
  fuzz::attempt([&] {
    const Json json = parse_json(text, "a.json", Exit::kUsage);
    const std::string printed = json.dump();
    fuzz::demand(parse_json(printed, "again", Exit::kFailure).dump() == printed,
                 "printed text that reads otherwise");
    switch (data[0] % 14) {
      case 0: {
        const Simulator simulator = parse_simulator(json, "sim.json", Exit::kData);
        parse_simulator(to_json(simulator), "again", Exit::kFailure);
        break;
      }
      case 1:
        parse_system(json, "system.json");
        break;
      case 2:
        parse_layout(json, "layout", Exit::kModel);
        break;
      case 3:
        parse_input_map(Options(json, "map", Exit::kUsage));
        break;
      case 4:
        InputMap::parse(json, "map", Exit::kModel);
        break;
      case 5: {
        const Recipe recipe = parse_recipe(json, "import.json");
        const Json written = to_json(recipe);
        fuzz::demand(to_json(parse_recipe(written, "again")) == written,
                     "a recipe that reads otherwise");
        break;
      }
      case 6:
        parse_teleop(json, "teleop.json");
        break;
      case 7:
        design::parse_limits(json, "limits", "/nowhere");
        break;
      case 8:
        parse_limits(json, "online");
        break;
      case 10: {
        const fuzz::MemoryFile file(text);
        ConfigurationFlags flags;
        flags.file = file.path();
        resolve(flags);
        break;
      }
      case 11:
        parse_chain(json, "arm.json", Exit::kData);
        break;
      case 12:
        parse_effects(json, "effects", Exit::kData);
        break;
      default: {
        const fuzz::MemoryFile file(text);
        read_calibration(file.path());
      }
    }
  });
  return 0;
}
