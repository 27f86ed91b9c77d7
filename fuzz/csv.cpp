// SPDX-License-Identifier: Apache-2.0
// Recordings: the first byte chooses the options, the rest is the file.
#include "dcnn/data/recording.h"
#include "fuzz/support.h"

using namespace dcnn;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  ReadOptions options;
  options.resample = (data[0] & 1) != 0;
  options.static_list = (data[0] & 2) != 0;
  options.motion_only = (data[0] & 4) != 0;
  if ((data[0] & 8) != 0) options.angle_unit = 0.01745;
  if ((data[0] & 16) != 0) options.force_sign = -1.0;
  static const System axes = parse_system(
      Json::parse(
          R"({"kind": "axes", "axes": [{"name": "a", "measured": "fx", "unit": "N", "position": "x"}]})"),
      "system");
  const System& system = (data[0] & 32) != 0 ? axes : System();
  const fuzz::MemoryFile file(fuzz::text_of(data + 1, size - 1));
  fuzz::attempt([&] {
    const Recording recording = read_recording(file.path(), options, system);
    fuzz::demand(recording.table.values.allFinite(), "a number that is not finite");
    fuzz::demand(
        !recording.segments.empty() && recording.segments.back().end == recording.samples(),
        "segments that do not cover the rows");
  });
  return 0;
}
