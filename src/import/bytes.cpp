#include "import/bytes.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace dcnn {
namespace {

constexpr std::uint64_t kBufferBytes = std::uint64_t{1} << 18;
constexpr std::uint64_t kLargestPiece = std::uint64_t{1} << 30;

using CrcTable = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTable make_crc_table() {
  CrcTable table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int k = 0; k < 8; ++k) c = (c & 1U) != 0U ? 0xEDB88320U ^ (c >> 1) : c >> 1;
    table[0][n] = c;
  }
  for (std::size_t n = 0; n < 256; ++n) {
    for (std::size_t k = 1; k < 8; ++k) {
      table[k][n] = table[0][table[k - 1][n] & 0xFFU] ^ (table[k - 1][n] >> 8);
    }
  }
  return table;
}

}  // namespace

ByteFile::ByteFile(const std::filesystem::path& path) : name_(path.string()) {
  fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  require(fd_ >= 0, Exit::kData, name_, ": cannot open: ", std::strerror(errno),
          "; check path and permissions");
  const off_t end = ::lseek(fd_, 0, SEEK_END);
  require(end >= 0, Exit::kData, name_, ": is not a regular file; write it to one first");
  size_ = static_cast<std::uint64_t>(end);
}

ByteFile::~ByteFile() {
  if (fd_ >= 0) ::close(fd_);
}

void ByteFile::fail_short(std::uint64_t count) const {
  fail(Exit::kData, name_, ": byte ", at_, ": ends in the middle of a record (", count,
       " bytes wanted, ", left(), " left); the log is cut off or damaged");
}

std::string_view ByteFile::take(std::uint64_t count) {
  if (count > left()) fail_short(count);
  require(count <= kLargestPiece, Exit::kData, name_, ": byte ", at_, ": a record of ", count,
          " bytes is more than is read at once (", kLargestPiece, ")");
  if (at_ < begin_ || at_ + count > end_) {
    const std::uint64_t want = std::min(std::max(count, kBufferBytes), left());
    if (buffer_.size() < want) buffer_.resize(static_cast<std::size_t>(want));
    begin_ = end_ = at_;
    while (end_ - begin_ < want) {
      const ssize_t got =
          ::pread(fd_, buffer_.data() + (end_ - begin_),
                  static_cast<std::size_t>(want - (end_ - begin_)), static_cast<off_t>(end_));
      if (got < 0 && errno == EINTR) continue;
      require(got >= 0, Exit::kData, name_, ": cannot read: ", std::strerror(errno));
      if (got == 0) break;  // became shorter while it was read
      end_ += static_cast<std::uint64_t>(got);
    }
    if (end_ - begin_ < count) fail_short(count);
  }
  const std::string_view part(buffer_.data() + (at_ - begin_), static_cast<std::size_t>(count));
  at_ += count;
  return part;
}

void ByteFile::skip(std::uint64_t count) {
  if (count > left()) fail_short(count);
  at_ += count;
}

void ByteFile::seek(std::uint64_t at) {
  require(at <= size_, Exit::kData, name_, ": points beyond its end (byte ", at, " of ", size_,
          "); the log is cut off or damaged");
  at_ = at;
}

std::uint32_t crc32(std::string_view bytes) {
  static constexpr CrcTable kTable = make_crc_table();
  std::uint32_t crc = 0xFFFFFFFFU;
  std::size_t k = 0;
  if constexpr (std::endian::native == std::endian::little) {  // eight bytes a step
    for (; k + 8 <= bytes.size(); k += 8) {
      std::uint32_t low = 0, high = 0;
      std::memcpy(&low, bytes.data() + k, 4);
      std::memcpy(&high, bytes.data() + k + 4, 4);
      low ^= crc;
      crc = kTable[7][low & 0xFFU] ^ kTable[6][(low >> 8) & 0xFFU] ^
            kTable[5][(low >> 16) & 0xFFU] ^ kTable[4][low >> 24] ^ kTable[3][high & 0xFFU] ^
            kTable[2][(high >> 8) & 0xFFU] ^ kTable[1][(high >> 16) & 0xFFU] ^
            kTable[0][high >> 24];
    }
  }
  for (; k < bytes.size(); ++k) {
    crc = kTable[0][(crc ^ static_cast<std::uint8_t>(bytes[k])) & 0xFFU] ^ (crc >> 8);
  }
  return crc ^ 0xFFFFFFFFU;
}

}  // namespace dcnn
