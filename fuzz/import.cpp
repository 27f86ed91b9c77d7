// Logs of other programs: text of any dialect, MCAP, ROS 1 bags, rosbag2, NumPy, MATLAB. What is
// read is proposed as a recording and assembled, as dcnn-import does without options; the recipe is
// read again as it was written.
#include <fcntl.h>

#include "dcnn/import/assemble.h"
#include "dcnn/import/summary.h"
#include "fuzz/support.h"

using namespace dcnn;

namespace {

/// A file with a name: SQLite opens no descriptor.
const std::filesystem::path& written(std::string_view bytes) {
  static const std::filesystem::path path =
      std::filesystem::path("/dev/shm") / ("dcnn-fuzz-log-" + std::to_string(::getpid()));
  static const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  fuzz::demand(::ftruncate(file, 0) == 0 &&
                   ::pwrite(file, bytes.data(), bytes.size(), 0) == ssize_t(bytes.size()),
               "no room for the log");
  return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path& path = written(fuzz::text_of(data, size));
  fuzz::attempt([&] {
    ReadLogOptions options;
    options.accept_truncated = size % 2 == 1;
    const ForeignLog log = read_log({path}, options);
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
