// SPDX-License-Identifier: Apache-2.0
// Sealed answers and a report, parted by a NUL byte: a seal whose SHA-256 is right, which nobody of
// ours wrote.
#include "dcnn/conceal/challenge.h"
#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "fuzz/support.h"

using namespace dcnn;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  const auto middle = text.find('\0');
  static const std::filesystem::path folder =
      std::filesystem::path("/dev/shm") / ("dcnn-fuzz-" + std::to_string(::getpid()));
  const std::string answers(text.substr(0, middle));
  const std::string report(middle == text.npos ? std::string_view("{}") : text.substr(middle + 1));
  write_file(folder / "set/seal.sha256", sha256_hex({answers}) + "  seal.json\n");
  write_file(folder / "seal.json", answers);
  write_file(folder / "set/reports/s0001/report.json", report);
  fuzz::attempt([&] { conceal::score_challenge(folder / "set", folder / "seal.json"); });
  return 0;
}
