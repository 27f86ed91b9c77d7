// SPDX-License-Identifier: Apache-2.0
// Every cycle as JSON to a plotting program, from a ring that never holds the loop up.
#include "dcnn/runtime/plot_stream.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <string>

#include "dcnn/core/json.h"
#include "support/no_allocation.h"

namespace dcnn {
namespace {

OnlineResult cycle(double t) {
  OnlineResult result;
  result.t = t;
  result.external << 1.5, -2.0, 3.0, 0.1, 0.2, 0.3;
  result.tool << 0.0, 0.0, -6.9, 0.0, 0.0, 0.0;
  result.state = RunState::kPhysics;
  result.contact = true;
  return result;
}

Json parsed(const OnlineResult& result, bool torque) {
  std::array<char, kMostPlotBytes> bytes;
  const std::size_t size = plot_text(result, 12e-6, torque, bytes);
  return Json::parse(std::string(bytes.data(), size));
}

TEST(PlotText, IsJsonWithTimestampWrenchesAndState) {
  const Json json = parsed(cycle(0.25), true);
  EXPECT_EQ(json["timestamp"].get<double>(), 0.25);
  EXPECT_EQ(json["external"]["fy"].get<double>(), -2.0);
  EXPECT_EQ(json["external"]["tz"].get<double>(), 0.3);
  EXPECT_EQ(json["tool"]["fz"].get<double>(), -6.9);
  EXPECT_EQ(json["state"].get<int>(), 2);
  EXPECT_EQ(json["contact"].get<int>(), 1);
  EXPECT_NEAR(json["cycle_us"].get<double>(), 12.0, 1e-9);
  EXPECT_FALSE(parsed(cycle(0.0), false)["external"].contains("tx"));
}

TEST(PlotText, FitsAndStaysJsonWhateverTheNumbersAre) {
  OnlineResult result = cycle(-1.2345678901234567e-300);
  result.external.setConstant(-1.2345678901234567e-300);
  result.tool.setConstant(-1.2345678901234567e-300);
  result.bias.setConstant(-1.2345678901234567e-300);
  result.novelty = NAN;
  const Json json = parsed(result, true);
  EXPECT_TRUE(json["novelty"].is_null());
  EXPECT_EQ(json["bias"]["fz"].get<double>(), -1.2345678901234567e-300);
}

/// A plotting program: a port that anybody may send to.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof name;
    ::bind(socket_, reinterpret_cast<sockaddr*>(&name), size);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&name), &size);
    port_ = std::to_string(ntohs(name.sin_port));
    const timeval patience{10, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  ~Listener() { ::close(socket_); }
  const std::string& port() const { return port_; }
  Json next() const {
    std::array<char, 2048> bytes;
    const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (size < 0) return nullptr;
    return parse_json({bytes.data(), static_cast<std::size_t>(size)}, "datagram", Exit::kData);
  }

 private:
  int socket_;
  std::string port_;
};

TEST(PlotStream, SendsEveryCycleInOrder) {
  const Listener listener;
  PlotStream stream(listener.port(), false);
  for (int k = 0; k < 100; ++k) stream.put(cycle(k), 0.0);
  for (int k = 0; k < 100; ++k) {
    const Json json = listener.next();
    ASSERT_TRUE(json.is_object()) << k;
    EXPECT_EQ(json["timestamp"].get<double>(), k);
  }
  EXPECT_EQ(stream.lost(), 0U);
}

TEST(PlotStream, LosesAndCountsWhatDoesNotFitAndNeverWaits) {
  const Listener listener;
  PlotStream stream(listener.port(), false);
  const OnlineResult result = cycle(0.0);
  const test::HeapCounter counter;
  for (int k = 0; k < 200'000; ++k) stream.put(result, 0.0);  // far faster than they are sent
  EXPECT_GT(stream.lost(), 0U);
  EXPECT_LT(stream.lost(), 200'000U);
  if (test::HeapCounter::works()) {
    EXPECT_EQ(test::HeapCounter::allocations(), 0);
    EXPECT_EQ(test::HeapCounter::locks(), 0);
  }
}

TEST(UdpAddress, OfAPortOutOfRangeIsRefused) {
  for (const char* address : {"99999", "0", "127.0.0.1:65536", "[::1]:70000", "999999999999999"}) {
    try {
      UdpSocket::to(address);
      ADD_FAILURE() << address;
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::kUsage);
      EXPECT_NE(std::string(error.what()).find("is not between 1 and 65535"), std::string::npos)
          << error.what();
    }
  }
  for (const char* address : {"", "localhost:", "5301x", "host:http"}) {
    EXPECT_THROW(UdpSocket::to(address), Error) << address;
  }
  EXPECT_NO_THROW(UdpSocket::to("65535"));
}

}  // namespace
}  // namespace dcnn
