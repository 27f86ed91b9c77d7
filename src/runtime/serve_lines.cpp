// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "dcnn/runtime/serve.h"
#include "runtime/tally.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostColumns = 256, kMostLine = 16384;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Where a column's number goes.
enum Slot { kTime, kPosition = 1, kQuaternion = 4, kEuler = 8, kWrench = 11, kRearm = 17, kSlots };
constexpr std::array<const char*, kSlots> kNames{"t",  "x",  "y",     "z",    "qw",    "qx",
                                                 "qy", "qz", "alpha", "beta", "gamma", "fx",
                                                 "fy", "fz", "tx",    "ty",   "tz",    "rearm"};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  return text;
}

/// Lines of a file descriptor through a buffer of fixed size.
class LineReader {
 public:
  explicit LineReader(int file) : file_(file) {}

  /// The next line without its end; nothing at the end of the file. A line that does not fit comes
  /// as an empty one.
  std::optional<std::string_view> next() noexcept {
    while (true) {
      const auto* end =
          static_cast<const char*>(std::memchr(buffer_.data() + begin_, '\n', end_ - begin_));
      if (end) {
        const std::string_view line(buffer_.data() + begin_,
                                    static_cast<std::size_t>(end - buffer_.data()) - begin_);
        begin_ += line.size() + 1;
        return std::exchange(too_long_, false) ? std::string_view() : line;
      }
      if (!fill()) {
        const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
        begin_ = end_;
        if (error_ != 0) return std::nullopt;  // what came before it is no whole line
        if (std::exchange(too_long_, false)) return std::string_view();
        return rest.empty() ? std::nullopt : std::optional(rest);
      }
    }
  }
  /// Why reading ended: 0 at the end of the file, else the number of an error.
  int error() const noexcept { return error_; }
  /// A whole line is there already, so that an answer can wait for its successor.
  bool ready() const noexcept {
    return std::memchr(buffer_.data() + begin_, '\n', end_ - begin_) != nullptr;
  }

 private:
  bool fill() noexcept {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    if (end_ == buffer_.size()) {
      end_ = 0;
      too_long_ = true;
    }
    ssize_t size = 0;
    do {
      size = ::read(file_, buffer_.data() + end_, buffer_.size() - end_);
    } while (size < 0 && errno == EINTR);
    error_ = size < 0 ? errno : 0;
    if (size <= 0) return false;
    end_ += static_cast<std::size_t>(size);
    return true;
  }

  int file_;
  std::array<char, kMostLine> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  bool too_long_ = false;
  int error_ = 0;
};

/// Text out through a buffer of fixed size.
class LineWriter {
 public:
  explicit LineWriter(int file) : file_(file) {}

  void put(std::string_view text) {
    if (size_ + text.size() > buffer_.size()) flush();
    std::memcpy(buffer_.data() + size_, text.data(), text.size());
    size_ += text.size();
  }
  void put(double value) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    put({text.data(), static_cast<std::size_t>(end - text.data())});
  }
  void flush() {
    for (std::size_t done = 0; done < size_;) {
      const ssize_t size = ::write(file_, buffer_.data() + done, size_ - done);
      require(size > 0 || errno == EINTR, Exit::kFailure, "standard output: cannot write");
      done += size > 0 ? static_cast<std::size_t>(size) : 0;
    }
    size_ = 0;
  }

 private:
  int file_;
  std::array<char, 8192> buffer_;
  std::size_t size_ = 0;
};

/// The header: which column is what.
class Columns {
 public:
  Columns(std::string_view header, bool torque, const ReadOptions& read) : read_(read) {
    slots_.fill(-1);
    std::array<bool, kSlots> found{};
    std::string_view rest = trimmed(header);
    while (true) {
      const auto comma = rest.find(',');
      const std::string_view name = trimmed(rest.substr(0, comma));
      require(count_ < kMostColumns, Exit::kData, "standard input:1: too many columns");
      const auto* known = std::find(kNames.begin(), kNames.end(), name);
      if (known != kNames.end()) {
        const auto slot = static_cast<std::size_t>(known - kNames.begin());
        require(!found[slot], Exit::kData, "standard input:1: column '", name, "' stands twice");
        found[slot] = true;
        slots_[count_] = static_cast<int>(slot);
      }
      ++count_;
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    const auto all = [&](int first, int many) {
      return std::all_of(found.begin() + first, found.begin() + first + many,
                         [](bool there) { return there; });
    };
    quaternion_ = all(kQuaternion, 4);
    const bool complete = all(kTime, 4) && (quaternion_ || all(kEuler, 3)) && all(kWrench, 3) &&
                          (!torque || all(kWrench + 3, 3));
    require(complete, Exit::kData, "standard input:1: needs the columns t,x,y,z, alpha,beta,gamma ",
            "or qw,qx,qy,qz, fx,fy,fz", torque ? ",tx,ty,tz" : "",
            "; write them as its first line");
  }

  /// NaN for what is no number; all NaN for a row of another length.
  OnlineSample read(std::string_view line) const noexcept {
    std::array<double, kSlots> values{};
    std::size_t column = 0;
    for (std::string_view rest = line; column <= count_; ++column) {
      const auto comma = rest.find(',');
      if (column < count_ && slots_[column] >= 0) {
        values[static_cast<std::size_t>(slots_[column])] = number(trimmed(rest.substr(0, comma)));
      }
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    if (column + 1 != count_) values.fill(kNan);
    OnlineSample sample;
    sample.t = values[kTime];
    sample.position = read_.position_unit * Eigen::Map<const Eigen::Vector3d>(&values[kPosition]);
    if (quaternion_) {
      sample.quaternion = Eigen::Map<const Eigen::Vector4d>(&values[kQuaternion]);
    } else {
      sample.euler = read_.angle_unit * Eigen::Map<const Eigen::Vector3d>(&values[kEuler]);
    }
    sample.wrench = read_.force_sign * Eigen::Map<const Vector6d>(&values[kWrench]);
    sample.rearm = values[kRearm] > 0.5;
    return sample;
  }

 private:
  static double number(std::string_view text) noexcept {
    double value = kNan;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? value : kNan;
  }

  std::array<int, kMostColumns> slots_;
  std::size_t count_ = 0;
  bool quaternion_ = false;
  const ReadOptions& read_;
};

void write_row(const OnlineResult& result, int targets, LineWriter& out) {
  out.put(result.t);
  for (int i = 0; i < targets; ++i) {
    out.put(",");
    out.put(result.external[i]);
  }
  out.put(",");
  out.put(name_of(result.state));
  out.put(",");
  out.put(name_of(result.reason));
  out.put(result.contact ? ",1\n" : ",0\n");
}

}  // namespace

Json serve_lines(OnlineCompensator& compensator, int in, int out, const ReadOptions& read,
                 PlotStream* plot) {
  LineReader lines(in);
  LineWriter answers(out);
  const auto header = lines.next();
  const auto require_end = [&] {
    require(lines.error() == 0, Exit::kFailure,
            "standard input: cannot read: ", std::strerror(lines.error()));
  };
  if (!header) require_end();
  require(header.has_value(), Exit::kData, "standard input: is empty; give a header and rows");
  const bool torque = compensator.has_torque();
  const Columns columns(*header, torque, read);
  answers.put(torque ? "t,fx_ext,fy_ext,fz_ext,tx_ext,ty_ext,tz_ext,state,reason,contact\n"
                     : "t,fx_ext,fy_ext,fz_ext,state,reason,contact\n");
  Tally tally;
  while (const auto line = lines.next()) {
    const double begin = thread_seconds();
    const OnlineResult& result = compensator.step(columns.read(*line));
    write_row(result, torque ? 6 : 3, answers);
    if (!lines.ready()) answers.flush();
    const double taken = thread_seconds() - begin;
    if (plot) plot->put(result, taken);
    tally.times.add(taken);
    tally.add(result);
  }
  answers.flush();
  require_end();
  return tally.to_json();
}

}  // namespace dcnn
