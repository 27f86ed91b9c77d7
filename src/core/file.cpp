#include "dcnn/core/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace dcnn {
namespace {

namespace fs = std::filesystem;

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

std::string reason() { return std::strerror(errno); }

void write_all(int fd, std::string_view bytes, const fs::path& path) {
  while (!bytes.empty()) {
    const auto written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    require(written > 0, Exit::kFailure, path.string(), ": cannot write: ", reason());
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void make_parent(const fs::path& path) {
  if (!path.has_parent_path()) return;
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  require(!error, Exit::kFailure, path.parent_path().string(),
          ": cannot make this folder: ", error.message());
}

void sync_folder(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  Descriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() >= 0)
    ::fsync(fd.get());  // not every file system can; the rename itself has happened
}

}  // namespace

std::string read_file(const fs::path& path, std::size_t max_bytes, Exit exit) {
  Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  require(fd.get() >= 0, exit, path.string(), ": cannot open: ", reason());
  struct stat info {};
  require(::fstat(fd.get(), &info) == 0, exit, path.string(), ": cannot read: ", reason());
  require(S_ISREG(info.st_mode), exit, path.string(), ": is not a regular file");
  const auto size = static_cast<std::size_t>(info.st_size);
  require(size <= max_bytes, exit, path.string(), ": larger than ", max_bytes, " bytes");
  std::string bytes(size, '\0');
  std::size_t have = 0;
  while (have < size) {
    const auto got = ::read(fd.get(), bytes.data() + have, size - have);
    if (got < 0 && errno == EINTR) continue;
    require(got >= 0, exit, path.string(), ": cannot read: ", reason());
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
  }
  bytes.resize(have);
  return bytes;
}

void write_file(const fs::path& path, std::string_view bytes) {
  make_parent(path);
  const std::string temporary = path.string() + ".tmp" + std::to_string(::getpid());
  try {
    Descriptor fd(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    require(fd.get() >= 0, Exit::kFailure, path.string(), ": cannot write: ", reason());
    write_all(fd.get(), bytes, path);
    require(::fsync(fd.get()) == 0, Exit::kFailure, path.string(), ": cannot write: ", reason());
    require(::rename(temporary.c_str(), path.c_str()) == 0, Exit::kFailure, path.string(),
            ": cannot replace: ", reason());
  } catch (const Error&) {
    ::unlink(temporary.c_str());
    throw;
  }
  sync_folder(path);
}

void append_line(const fs::path& path, std::string_view line) {
  make_parent(path);
  Descriptor fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  require(fd.get() >= 0, Exit::kFailure, path.string(), ": cannot write: ", reason());
  write_all(fd.get(), std::string(line) + "\n", path);
}

}  // namespace dcnn
