// SPDX-License-Identifier: Apache-2.0
// Compressed pieces of logs, with a bound on what they may become.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace dcnn {

/// Counts what a file's pieces expand to: at most 1000 times the file and 64 MB, and 256 MB a
/// piece. (LZ4 cannot expand further than 255 times; real logs stay below 100.)
class Decompressor {
 public:
  Decompressor(std::string file, std::uint64_t file_bytes)
      : file_(std::move(file)), file_bytes_(file_bytes) {}

  /// `kind`: "" or "none", "lz4" (frames), "zstd", "bz2", "deflate" (raw). Exactly `size` bytes
  /// come out, anything else is an Error(kData). Valid until the next call.
  std::string_view expand(std::string_view kind, std::string_view bytes, std::uint64_t size);

 private:
  std::string file_;
  std::uint64_t file_bytes_, expanded_ = 0;
  std::string buffer_;
};

/// "lz4, zstd, bz2, deflate": what this build can expand.
std::string known_compressions();

}  // namespace dcnn
