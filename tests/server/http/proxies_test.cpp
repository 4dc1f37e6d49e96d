#include "server/http/proxies.hpp"

#include <gtest/gtest.h>

#include "core/units/error.hpp"

namespace roadfix::http {
namespace {

TEST(Proxies, AreAddressesAndNetworksOfBothKinds) {
  const Proxies proxies({"127.0.0.1", "10.0.0.0/8", "192.168.16.0/20", "fd00::/8", "::1"});
  for (const char* inside : {"127.0.0.1", "::ffff:127.0.0.1", "10.255.0.1", "192.168.31.255", "fd12::1", "::1"}) {
    EXPECT_TRUE(proxies.contains(inside)) << inside;
  }
  for (const char* outside : {"127.0.0.2", "11.0.0.1", "192.168.32.0", "fe80::1", "::2", "", "localhost"}) {
    EXPECT_FALSE(proxies.contains(outside)) << outside;
  }
  EXPECT_TRUE(Proxies({"0.0.0.0/0"}).contains("203.0.113.9"));
  EXPECT_FALSE(Proxies({"0.0.0.0/0"}).contains("2001:db8::1"));
}

TEST(Proxies, AreBelievedOnWhoAsksAndNobodyElseIs) {
  const Proxies proxies({"127.0.0.1", "10.0.0.0/8"});
  EXPECT_EQ(proxies.client("127.0.0.1", "203.0.113.9"), "203.0.113.9");
  EXPECT_EQ(proxies.client("203.0.113.7", "203.0.113.9"), "203.0.113.7") << "came past the proxy";
  EXPECT_EQ(proxies.client("127.0.0.1", ""), "127.0.0.1");
  EXPECT_EQ(Proxies().client("127.0.0.1", "203.0.113.9"), "127.0.0.1");
}

TEST(Proxies, AreFollowedBackToTheFirstThatIsNone) {
  const Proxies proxies({"127.0.0.1", "10.0.0.0/8"});
  EXPECT_EQ(proxies.client("127.0.0.1", "198.51.100.1, 203.0.113.9, 10.1.2.3"), "203.0.113.9")
      << "198.51.100.1 may have been written by the client";
  EXPECT_EQ(proxies.client("127.0.0.1", "10.1.2.3, 10.1.2.4"), "10.1.2.3") << "a client within";
}

TEST(Proxies, MayNameThePortAndWriteNonsense) {
  const Proxies proxies({"127.0.0.1"});
  EXPECT_EQ(proxies.client("127.0.0.1", "203.0.113.9:4711"), "203.0.113.9");
  EXPECT_EQ(proxies.client("127.0.0.1", "[2001:db8::1]:4711"), "2001:db8::1");
  EXPECT_EQ(proxies.client("127.0.0.1", "2001:db8::1"), "2001:db8::1");
  for (const char* nonsense : {"unknown", "[", ",", " , ", "203.0.113.9 203.0.113.8", "\"quoted\""}) {
    EXPECT_EQ(proxies.client("127.0.0.1", nonsense), "127.0.0.1") << nonsense;
  }
}

TEST(Proxies, AreRefusedWhereTheyAreNoNetwork) {
  for (const char* text :
       {"", "localhost", "10.0.0.0/33", "10.0.0.0/-1", "10.0.0.0/", "10.0.0.0/8x", "fd00::/129", "/8"}) {
    EXPECT_THROW(Proxies({text}), InvalidInput) << text;
  }
}

}  // namespace
}  // namespace roadfix::http
