// SPDX-License-Identifier: Apache-2.0
#include "import/bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace dcnn {
namespace {

constexpr std::uint64_t kBufferBytes = std::uint64_t{1} << 18;
constexpr std::uint64_t kLargestPiece = std::uint64_t{1} << 30;

}  // namespace

ByteFile::ByteFile(const std::filesystem::path& path) : name_(path.string()) {
  fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // does not wait for a FIFO
  require(fd_ >= 0, Exit::kData, name_, ": cannot open: ", std::strerror(errno),
          "; check path and permissions");
  struct stat about {};
  const bool regular = ::fstat(fd_, &about) == 0 && S_ISREG(about.st_mode);
  const off_t end = regular ? ::lseek(fd_, 0, SEEK_END) : -1;
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

}  // namespace dcnn
