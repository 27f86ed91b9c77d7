// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/udp.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <poll.h>
#include <sodium.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <ctime>
#include <memory>

namespace dcnn {
namespace {

using Address = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

/// getaddrinfo() takes the last 16 bits of any number.
void require_port(const std::string& port, const std::string& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  const bool read = error == std::errc() && end == port.data() + port.size();
  require(read || error == std::errc::result_out_of_range, Exit::kUsage, "'", text,
          "' is no address; give HOST:PORT or PORT, for example 127.0.0.1:5301");
  require(read && number >= 1 && number <= 65535, Exit::kUsage, "'", text, "': port ", port,
          " is not between 1 and 65535");
}

Address resolve(const std::string& text) {
  const auto colon = text.rfind(':');
  std::string host = colon == std::string::npos ? "" : text.substr(0, colon);
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  if (host.size() > 1 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  if (host.empty()) host = "127.0.0.1";
  require_port(port, text);
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  require(error == 0 && !port.empty(), Exit::kUsage, "'", text, "' is no address HOST:PORT",
          error ? std::string(": ") + ::gai_strerror(error) : "");
  return {found, &::freeaddrinfo};
}

/// Of two that speak with each other.
std::pair<Address, Address> resolve_both(const std::string& listen, const std::string& peer) {
  Address here = resolve(listen), there = resolve(peer);
  require(here->ai_family == there->ai_family, Exit::kUsage, "'", listen, "' and '", peer,
          "' are addresses of different kinds; give two of IPv4 or two of IPv6");
  require(here->ai_addrlen != there->ai_addrlen ||
              std::memcmp(here->ai_addr, there->ai_addr, here->ai_addrlen) != 0,
          Exit::kUsage, "'", listen, "' and '", peer,
          "' are one address, which would hear itself; give the peer's own");
  return {std::move(here), std::move(there)};
}

/// Room for what comes while the process waits for a core: at 100,000 packets a second the usual
/// 200 KiB are full after 3 ms, and right packets are lost with wrong ones.
void make_room(int socket) {
  constexpr int kBytes = 4 << 20;
  if (::setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &kBytes, sizeof kBytes) != 0) {
    ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kBytes, sizeof kBytes);
  }
}

}  // namespace

double monotonic_seconds() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void expect_addresses(const std::string& listen, const std::string& peer) {
  resolve_both(listen, peer);
}

UdpSocket::UdpSocket(const std::string& listen, const std::string& peer) {
  const auto [here, there] = resolve_both(listen, peer);
  socket_ = ::socket(here->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  require(socket_ >= 0, Exit::kFailure, "cannot open a socket: ", std::strerror(errno));
  const char* step = "listen at ";
  make_room(socket_);
  bool done = ::bind(socket_, here->ai_addr, here->ai_addrlen) == 0;
  if (done) {
    step = "reach ";
    done = ::connect(socket_, there->ai_addr, there->ai_addrlen) == 0;
  }
  const int error = errno;
  if (!done) ::close(socket_);
  require(done, Exit::kFailure, "cannot ", step, *step == 'l' ? listen : peer, ": ",
          std::strerror(error));
}

UdpSocket UdpSocket::to(const std::string& peer) {
  const Address there = resolve(peer);
  UdpSocket end(::socket(there->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  require(end.socket_ >= 0 && ::connect(end.socket_, there->ai_addr, there->ai_addrlen) == 0,
          Exit::kFailure, "cannot send to ", peer, ": ", std::strerror(errno));
  return end;
}

UdpSocket::~UdpSocket() {
  if (socket_ >= 0) ::close(socket_);
}

std::pair<UdpSocket, UdpSocket> UdpSocket::pair() {
  UdpSocket ends[] = {UdpSocket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)),
                      UdpSocket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))};
  sockaddr_in names[2] = {};
  bool done = true;
  for (int i = 0; i < 2; ++i) {
    names[i].sin_family = AF_INET;
    names[i].sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* name = reinterpret_cast<sockaddr*>(&names[i]);
    socklen_t size = sizeof names[i];
    done = done && ::bind(ends[i].socket_, name, size) == 0 &&
           ::getsockname(ends[i].socket_, name, &size) == 0;
  }
  for (int i = 0; i < 2; ++i) {
    done = done && ::connect(ends[i].socket_, reinterpret_cast<sockaddr*>(&names[1 - i]),
                             sizeof names[1 - i]) == 0;
  }
  require(done, Exit::kFailure, "cannot open sockets on the loopback: ", std::strerror(errno));
  return {std::move(ends[0]), std::move(ends[1])};
}

std::optional<std::size_t> UdpSocket::receive(std::span<std::uint8_t> buffer,
                                              double deadline) noexcept {
  while (true) {
    const ssize_t size = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (size >= 0) return static_cast<std::size_t>(size);
    if (errno == ECONNREFUSED) continue;  // nobody was there for an earlier packet
    if (errno != EAGAIN && errno != EINTR) return std::nullopt;
    const double left = deadline - monotonic_seconds();
    if (!(left > 0.0)) return std::nullopt;
    const double whole = std::floor(std::min(left, 1e6));
    const timespec wait{static_cast<time_t>(whole), static_cast<long>(1e9 * (left - whole))};
    pollfd ready{socket_, POLLIN, 0};
    if (::ppoll(&ready, 1, &wait, nullptr) <= 0) return std::nullopt;
  }
}

bool UdpSocket::send(std::span<const std::uint8_t> bytes) noexcept {
  return ::send(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL) ==
         static_cast<ssize_t>(bytes.size());
}

RobotLink::RobotLink(const std::string& listen, const std::string& peer, const PacketKey& key)
    : socket_(listen, peer), session_(key) {
  require(sodium_init() >= 0, Exit::kFailure, "no source of randomness");
}

bool RobotLink::connect(double seconds) {
  constexpr double kRetry = 0.1;  // s
  std::uint64_t nonce = 0;
  randombytes_buf(&nonce, sizeof nonce);
  const double end = monotonic_seconds() + seconds;
  for (double now = monotonic_seconds(); now < end; now = monotonic_seconds()) {
    socket_.send(session_.hello(nonce, now));
    std::array<std::uint8_t, kMostBytes> buffer;
    while (const auto size = socket_.receive(buffer, std::min(now + kRetry, end))) {
      if (session_.take_welcome({buffer.data(), *size})) return true;
    }
  }
  return false;
}

std::uint64_t RobotLink::send(const OnlineSample& sample) noexcept {
  if (!session_.open()) return 0;
  socket_.send(session_.sample(sample));
  return session_.sequence();
}

std::optional<WireResult> RobotLink::receive(double deadline) noexcept {
  std::array<std::uint8_t, kMostBytes> buffer;
  while (const auto size = socket_.receive(buffer, deadline)) {
    if (auto result = session_.take_result({buffer.data(), *size})) return result;
  }
  return std::nullopt;
}

}  // namespace dcnn
