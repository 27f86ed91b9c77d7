// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/plot_stream.h"

#include <charconv>
#include <cmath>
#include <ctime>
#include <string_view>

namespace dcnn {
namespace {

/// One JSON object in fixed memory.
class PlotText {
 public:
  void put(std::string_view text) {
    const auto size = std::min(text.size(), buffer_.size() - size_);
    std::copy_n(text.begin(), size, buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += size;
  }
  void put(std::string_view name, double value) {
    put(name);
    if (!std::isfinite(value)) return put("null");
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    put({text.data(), static_cast<std::size_t>(end - text.data())});
  }
  std::string_view text() const { return {buffer_.data(), size_}; }

 private:
  std::array<char, kMostPlotBytes> buffer_;
  std::size_t size_ = 0;
};

void put_wrench(std::string_view name, const Vector6d& wrench, bool torque, PlotText& out) {
  constexpr std::array<std::string_view, 6> kKeys{
      "{\"fx\":", ",\"fy\":", ",\"fz\":", ",\"tx\":", ",\"ty\":", ",\"tz\":"};
  out.put(name);
  for (std::size_t i = 0; i < (torque ? 6U : 3U); ++i) {
    out.put(kKeys[i], wrench[static_cast<Eigen::Index>(i)]);
  }
  out.put("}");
}

}  // namespace

std::size_t plot_text(const OnlineResult& result, double cycle_s, bool torque,
                      std::span<char, kMostPlotBytes> to) noexcept {
  PlotText out;
  out.put("{\"timestamp\":", result.t);
  put_wrench(",\"external\":", result.external, torque, out);
  put_wrench(",\"tool\":", result.tool, torque, out);
  out.put(",\"bias\":{\"fx\":", result.bias[0]);
  out.put(",\"fy\":", result.bias[1]);
  out.put(",\"fz\":", result.bias[2]);
  out.put("},\"state\":", static_cast<double>(result.state));
  out.put(",\"reason\":", static_cast<double>(result.reason));
  out.put(",\"contact\":", result.contact ? 1.0 : 0.0);
  out.put(",\"limited\":", result.limited ? 1.0 : 0.0);
  out.put(",\"novelty\":", result.novelty);
  out.put(",\"cycle_us\":", 1e6 * cycle_s);
  out.put("}");
  std::copy(out.text().begin(), out.text().end(), to.begin());
  return out.text().size();
}

PlotStream::PlotStream(const std::string& address, bool torque)
    : socket_(UdpSocket::to(address)),
      torque_(torque),
      ring_(kRecords),
      sender_([this] { serve(); }) {}

PlotStream::~PlotStream() {
  stop_.store(true, std::memory_order_release);
  sender_.join();
}

void PlotStream::put(const OnlineResult& result, double cycle_s) noexcept {
  const auto head = head_.load(std::memory_order_relaxed);
  if (head - tail_.load(std::memory_order_acquire) >= kRecords) {
    lost_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  ring_[head % kRecords] = {result, cycle_s};
  head_.store(head + 1, std::memory_order_release);
}

/// Sends what is there; false where nothing was.
bool PlotStream::drain() noexcept {
  const auto head = head_.load(std::memory_order_acquire);
  auto tail = tail_.load(std::memory_order_relaxed);
  const bool some = tail != head;
  std::array<char, kMostPlotBytes> buffer;
  while (tail != head) {
    const Record& record = ring_[tail % kRecords];
    const std::size_t size = plot_text(record.result, record.cycle_s, torque_, buffer);
    tail_.store(++tail, std::memory_order_release);
    socket_.send({reinterpret_cast<const std::uint8_t*>(buffer.data()), size});
  }
  return some;
}

void PlotStream::serve() noexcept {
  constexpr timespec kPause{0,
                            5'000'000};  // two or three samples at 500 Hz: plots are drawn at 50 Hz
  while (!stop_.load(std::memory_order_acquire)) {
    if (!drain()) ::nanosleep(&kPause, nullptr);
  }
  drain();
}

}  // namespace dcnn
