// SPDX-License-Identifier: Apache-2.0
#include "data/line_reader.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "dcnn/core/standard_input.h"

namespace dcnn {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 18;
constexpr std::size_t kMaxLine = std::size_t{1} << 20;

}  // namespace

LineReader::LineReader(const std::filesystem::path& path) : name_(path.string()) {
  buffer_.resize(kChunkBytes);
  if (path == "-") {
    name_ = "standard input";
    return;
  }
  std::error_code error;
  const auto status =
      std::filesystem::status(path, error);  // opening a pipe would wait for its writer
  require(std::filesystem::exists(status), Exit::kData, name_,
          ": does not exist or cannot be reached; check the path");
  require(!std::filesystem::is_directory(status), Exit::kData, name_,
          ": is a folder; name the CSV file in it");
  require(std::filesystem::is_regular_file(status), Exit::kData, name_,
          ": is not a regular file; pipe it in as - or write it to a file first");
  fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  require(fd_ >= 0, Exit::kData, name_, ": cannot open: ", std::strerror(errno),
          "; check the permissions");
}

LineReader::~LineReader() {
  if (fd_ >= 0) ::close(fd_);
}

bool LineReader::next(std::string_view* line) {
  for (;;) {
    const char* unread = buffer_.data() + begin_;
    if (const void* found = std::memchr(unread, '\n', end_ - begin_)) {
      return take(static_cast<std::size_t>(static_cast<const char*>(found) - unread), line);
    }
    if (ended_ && begin_ == end_) return false;
    if (ended_) return take(end_ - begin_, line);
    refill();
  }
}

bool LineReader::take(std::size_t length, std::string_view* line) {
  ++number_;
  if (length > kMaxLine) {  // a place costs more than a line, so only where it is needed
    fail(Exit::kData, place(), ": line longer than ", kMaxLine, " bytes; is this a CSV file?");
  }
  *line = std::string_view(buffer_.data() + begin_, length);
  begin_ = std::min(begin_ + length + 1, end_);
  if (!line->empty() && line->back() == '\r') line->remove_suffix(1);
  return true;
}

void LineReader::refill() {
  require(end_ - begin_ <= kMaxLine, Exit::kData, place(number_ + 1), ": line longer than ",
          kMaxLine, " bytes; is this a CSV file?");
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (buffer_.size() < end_ + kChunkBytes) buffer_.resize(end_ + kChunkBytes);
  const std::size_t got = read(buffer_.data() + end_);
  read_ += got;
  end_ += got;
  ended_ = got == 0;
}

std::size_t LineReader::read(char* to) const {
  if (fd_ < 0) return read_standard_input(read_, to, kChunkBytes, Exit::kData);
  ssize_t got = 0;
  do {
    got = ::read(fd_, to, kChunkBytes);
  } while (got < 0 && errno == EINTR);
  require(got >= 0, Exit::kData, name_, ": cannot read: ", std::strerror(errno));
  return static_cast<std::size_t>(got);
}

}  // namespace dcnn
