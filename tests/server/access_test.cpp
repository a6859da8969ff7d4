// SPDX-License-Identifier: BSD-3-Clause
#include "server/access.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tessera::server {
namespace {

const std::string token = "0123456789abcdef0123456789abcdef";

Access at_loopback(std::vector<std::string> allowed = {}) { return {token, "127.0.0.1", std::move(allowed)}; }

/// Credentials of a normal request with the token.
Credentials good() { return {"127.0.0.1:8080", "", "", "", "token=0123456789abcdef0123456789abcdef"}; }

TEST(Access, AcceptsTheTokenOnlyFromQueryHeaderOrSubprotocol) {
  const Access access = at_loopback();
  EXPECT_FALSE(access.refusal(good()));
  Credentials c = good();
  c.query = "";
  EXPECT_TRUE(access.refusal(c));
  for (const std::string& protocols : {"token." + token, "tessera, token." + token, " token." + token + " ,tessera"}) {
    c.protocols = protocols;
    EXPECT_FALSE(access.refusal(c)) << protocols;
  }
  for (const std::string& protocols : {std::string("tessera"), std::string("token."), "token." + token + "0",
                                       "token." + token.substr(1), "xtoken." + token, token}) {
    c.protocols = protocols;
    EXPECT_TRUE(access.refusal(c)) << protocols;
  }
  c.protocols = "";
  c.token = token;
  EXPECT_FALSE(access.refusal(c));
  c.token = "0123456789abcdef0123456789abcdee";
  EXPECT_TRUE(access.refusal(c));
  c.token = "";
  const std::string bearer = "Bearer " + token;
  for (const std::string& right : {bearer, "bearer " + token}) {
    c.authorization = right;
    EXPECT_FALSE(access.refusal(c)) << right;
  }
  for (const std::string& wrong : {bearer + "0", bearer.substr(0, 20), "Basic " + token, std::string("Bearer ")}) {
    c.authorization = wrong;
    EXPECT_TRUE(access.refusal(c)) << wrong;
  }
  c.authorization = "";
  for (const char* query :
       {"token=", "token=0123456789abcdef0123456789abcdee", "Token=0123456789abcdef0123456789abcdef",
        "xtoken=0123456789abcdef0123456789abcdef", "token=%zz"}) {
    c.query = query;
    EXPECT_TRUE(access.refusal(c)) << query;
  }
}

TEST(Access, IsCalledByLoopbackNamesItsAddressOrAllowedNames) {
  const Access access = at_loopback({"Viz.Example.org"});
  Credentials c = good();
  for (const char* host :
       {"127.0.0.1", "localhost:1", "LOCALHOST:65535", "127.3.2.1:80", "[::1]:9000", "viz.example.org:443"}) {
    c.host = host;
    EXPECT_FALSE(access.refusal(c)) << host;
  }
  for (const char* host : {"", "evil.org", "127.0.0.1.evil.org", "localhost.evil.org", "127.evil.0.1", "localhost:80x",
                           "[::1", "localhost:123456", "0.0.0.0:80", "viz.example.org.evil"}) {
    c.host = host;
    EXPECT_TRUE(access.refusal(c)) << host;
  }
}

TEST(Access, RefusesPagesOfOtherServers) {
  const Access access = at_loopback({"viz.example.org"});
  Credentials c = good();
  for (const char* origin : {"http://127.0.0.1:8080", "https://viz.example.org", "https://viz.example.org:8443"}) {
    c.origin = origin;
    EXPECT_FALSE(access.refusal(c)) << origin;
  }
  for (const char* origin : {"null", "http://127.0.0.1:8081", "http://localhost:8080", "http://evil.org", "http://",
                             "127.0.0.1:8080", "http://127.0.0.1:8080.evil.org"}) {
    c.origin = origin;
    EXPECT_TRUE(access.refusal(c)) << origin;
  }
  c.host = "localhost";
  c.origin = "http://localhost:80";
  EXPECT_FALSE(access.refusal(c));
}

TEST(Access, ServesThePageToRequestsWithTheServersHostName) {
  const Access access = at_loopback({"viz.example.org"});
  for (const char* host : {"127.0.0.1:8080", "localhost", "viz.example.org"}) {
    EXPECT_FALSE(access.page_refusal(host)) << host;
  }
  EXPECT_TRUE(access.page_refusal(""));
}

TEST(Access, NamesTheOptionThatAllowsAnAddress) {
  const Access access = at_loopback();
  Credentials c = good();
  c.origin = "https://viz.example.org:8443";
  EXPECT_NE(access.refusal(c).value_or("").find("--allow-host viz.example.org."), std::string::npos);
  c.origin = "";
  c.host = "Viz.example.org:80";
  EXPECT_NE(access.refusal(c).value_or("").find("--allow-host viz.example.org "), std::string::npos);
  EXPECT_EQ(access.refusal(c), access.page_refusal(c.host));
}

TEST(Access, MakesAnotherTokenOf128BitsEachTime) {
  const Access a("127.0.0.1", {}), b("127.0.0.1", {});
  EXPECT_EQ(a.token().size(), 32u);
  EXPECT_NE(a.token(), b.token());
}

TEST(Access, DecodesQueries) {
  EXPECT_EQ(query_value("a=1&state=%7B%22a%22%3A+1%7D&b", "state"), "{\"a\": 1}");
  EXPECT_EQ(query_value("a=1&b=2", "b"), "2");
  EXPECT_EQ(query_value("&&=&b", "b"), std::nullopt);
  EXPECT_EQ(query_value("b=%4", "b"), std::nullopt);
  EXPECT_EQ(decoded("a+b%20c", false), "a+b c");
}

}  // namespace
}  // namespace tessera::server
