#include <gtest/gtest.h>
#include <sys/stat.h>

#include "dcnn/runtime/packet.h"
#include "support/process.h"

namespace dcnn {
namespace {

TEST(PacketKeyFile, APipeIsRefusedAndNotWaitedFor) {
  const test::TemporaryFolder folder;
  const auto pipe = folder / "key";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ::alarm(60);  // the end of a test that waits
  EXPECT_THROW(read_packet_key(pipe), Error);
  ::alarm(0);
}

}  // namespace
}  // namespace dcnn
