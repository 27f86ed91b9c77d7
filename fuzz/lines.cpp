// SPDX-License-Identifier: Apache-2.0
// Rows on the standard input of dcnn-run: any bytes are answered, and every number put out is
// finite and bounded.
#include <fcntl.h>

#include <charconv>
#include <cmath>

#include "dcnn/core/file.h"
#include "dcnn/runtime/open.h"
#include "dcnn/runtime/serve.h"
#include "fuzz/support.h"

using namespace dcnn;

namespace {

/// The numbers of an answer: all finite, forces within the guard's bound.
void check(std::string_view line, double bound) {
  int column = 0;
  while (column < 4) {
    const auto comma = line.find(',');
    const std::string_view cell = line.substr(0, comma);
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    const bool number = error == std::errc() && end == cell.data() + cell.size();
    fuzz::demand(column == 0 || (number && std::isfinite(value) && std::abs(value) <= bound),
                 "an output beyond its bound");
    if (comma == line.npos) break;
    line.remove_prefix(comma + 1);
    ++column;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::NamedFile model(
      std::filesystem::temp_directory_path(), ".json",
      R"({"tool": {"mass_kg": 0.7, "com_m": [0, 0, 0.1]}, "model": {"inertial": "none"}, "sample_rate_hz": 500,
          "derivative": {"kind": "sg_causal", "window_s": 0.02, "order": 2}})");
  CompensatorOptions options;
  OnlineFiles files;
  files.model = model.path();
  OnlineCompensator compensator = open_compensator(files, options, [](const std::string&) {});
  const fuzz::MemoryFile in(fuzz::text_of(data, size)), out("");
  const int source = ::open(in.path().c_str(), 0), sink = ::open(out.path().c_str(), 2);
  fuzz::attempt([&] { serve_lines(compensator, source, sink); });
  ::close(source);
  ::close(sink);
  const std::string answers = read_file(out.path(), std::size_t{1} << 26, Exit::kData);
  std::size_t begin = answers.find('\n');
  while (begin != answers.npos && begin + 1 < answers.size()) {
    const auto end = answers.find('\n', begin + 1);
    check(std::string_view(answers).substr(begin + 1, end - begin - 1), options.guard.force_n);
    begin = end;
  }
  return 0;
}
