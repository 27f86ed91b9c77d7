// SPDX-License-Identifier: Apache-2.0
#include "import/decompress.h"

#include <functional>
#include <map>

#include "data/text.h"
#include "dcnn/core/error.h"

#ifdef DCNN_WITH_LZ4
#include <lz4frame.h>
#endif
#ifdef DCNN_WITH_ZSTD
#include <zstd.h>
#endif
#ifdef DCNN_WITH_BZIP2
#include <bzlib.h>
#endif
#ifdef DCNN_WITH_ZLIB
#include <zlib.h>
#endif

namespace dcnn {
namespace {

constexpr std::uint64_t kMostExpansion = 1000, kFreeBytes = std::uint64_t{64} << 20;
constexpr std::uint64_t kMostPiece = std::uint64_t{256} << 20;

/// Whether exactly all of `out` was filled.
using Expand = std::function<bool(std::string_view in, std::string* out)>;

#ifdef DCNN_WITH_LZ4
bool expand_lz4(std::string_view in, std::string* out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0U) return false;
  std::size_t from = 0, to = 0, hint = 1;
  while (hint != 0 && from < in.size()) {
    std::size_t taken = in.size() - from, given = out->size() - to;
    hint = LZ4F_decompress(context, out->data() + to, &given, in.data() + from, &taken, nullptr);
    if (LZ4F_isError(hint) != 0U || (taken == 0 && given == 0)) break;
    from += taken;
    to += given;
  }
  LZ4F_freeDecompressionContext(context);
  return hint == 0 && to == out->size();
}
#endif

#ifdef DCNN_WITH_ZSTD
bool expand_zstd(std::string_view in, std::string* out) {
  return ZSTD_decompress(out->data(), out->size(), in.data(), in.size()) == out->size();
}
#endif

#ifdef DCNN_WITH_BZIP2
bool expand_bz2(std::string_view in, std::string* out) {
  auto size = static_cast<unsigned>(out->size());
  const int state = BZ2_bzBuffToBuffDecompress(out->data(), &size, const_cast<char*>(in.data()),
                                               static_cast<unsigned>(in.size()), 0, 0);
  return state == BZ_OK && size == out->size();
}
#endif

#ifdef DCNN_WITH_ZLIB
bool expand_deflate(std::string_view in, std::string* out) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return false;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out->data());
  stream.avail_out = static_cast<uInt>(out->size());
  const int state = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  return state == Z_STREAM_END && stream.total_out == out->size();
}
#endif

const std::map<std::string, Expand, std::less<>>& expanders() {
  static const std::map<std::string, Expand, std::less<>> kExpanders = {
#ifdef DCNN_WITH_LZ4
      {"lz4", expand_lz4},
#endif
#ifdef DCNN_WITH_ZSTD
      {"zstd", expand_zstd},
#endif
#ifdef DCNN_WITH_BZIP2
      {"bz2", expand_bz2},
#endif
#ifdef DCNN_WITH_ZLIB
      {"deflate", expand_deflate},
#endif
  };
  return kExpanders;
}

const char* package_of(std::string_view kind) {
  if (kind == "lz4") return "liblz4-dev";
  if (kind == "zstd") return "libzstd-dev";
  return kind == "bz2" ? "libbz2-dev" : "zlib1g-dev";
}

}  // namespace

std::string_view Decompressor::expand(std::string_view kind, std::string_view bytes,
                                      std::uint64_t size) {
  if (kind.empty() || kind == "none") {
    require(bytes.size() == size, Exit::kData, file_, ": a piece of ", bytes.size(),
            " bytes says that it has ", size);
    return bytes;
  }
  const bool known = kind == "lz4" || kind == "zstd" || kind == "bz2" || kind == "deflate";
  require(known, Exit::kData, file_, ": the compression ", shown(kind), " is not known");
  const auto found = expanders().find(kind);
  require(found != expanders().end(), Exit::kData, file_, ": is compressed by ", std::string(kind),
          ", which this build was made without; install ", package_of(kind), " and build again");
  expanded_ += std::min(size, kMostPiece + 1);
  require(size <= kMostPiece && expanded_ <= kFreeBytes + kMostExpansion * file_bytes_, Exit::kData,
          file_, ": would expand to more than ", kMostPiece >> 20, " MB a piece or ",
          kMostExpansion, " times its size; no log does");
  buffer_.resize(static_cast<std::size_t>(size));
  require(found->second(bytes, &buffer_), Exit::kData, file_, ": a piece compressed by ",
          std::string(kind), " is damaged, or not of the size that it states");
  return buffer_;
}

std::string known_compressions() {
  std::string words;
  for (const auto& [kind, unused] : expanders()) words += (words.empty() ? "" : ", ") + kind;
  return words.empty() ? "none" : words;
}

}  // namespace dcnn
