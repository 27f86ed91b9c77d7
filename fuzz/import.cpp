// SPDX-License-Identifier: Apache-2.0
// Logs of other programs: text of any dialect, MCAP, ROS 1 bags, rosbag2, NumPy, MATLAB, JSON. What
// is read is proposed as a recording and assembled, as dcnn-import does without options; the recipe
// is read again as it was written.
#include "dcnn/import/assemble.h"
#include "dcnn/import/summary.h"
#include "fuzz/support.h"

using namespace dcnn;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::NamedFile file("/dev/shm");  // SQLite opens no descriptor
  file.write(fuzz::text_of(data, size));
  fuzz::attempt([&] {
    ReadLogOptions options;
    options.accept_truncated = size % 2 == 1;
    const ForeignLog log = read_log({file.path()}, options);
    Proposal proposal = propose(log, {});
    proposal.recipe.files = 1;
    describe(log, proposal.recipe);
    describe_json(log, proposal).dump();
    const Recipe again = parse_recipe(to_json(proposal.recipe), "import.json");
    fuzz::demand(to_json(again) == to_json(proposal.recipe), "a recipe that reads otherwise");
    assemble(log, again);
  });
  return 0;
}
