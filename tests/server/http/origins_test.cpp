#include "server/http/origins.hpp"

#include "tests/server/http/server_fixture.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::http {
namespace {

using roadfix::testing::code_of;

std::string answer_to(const ServedNames& names, const std::string& host) {
  Request request;
  request.headers["host"] = host;
  return code_of([&] { names.require(request); });
}

TEST(ServedNames, AreThoseOfThisMachineAndTheOnesTold) {
  for (const char* own : {"127.0.0.1", "127.0.0.2", "localhost", "::1"}) {
    const ServedNames names(own, {"Maps.example.org"});
    for (const char* host : {"localhost", "LocalHost:8080", "127.0.0.1:8080", "127.1.2.3", "[::1]:8080", "[::1]", "",
                             "maps.example.org", "MAPS.example.org:443"}) {
      EXPECT_EQ(answer_to(names, host), "no error") << own << ": " << host;
    }
    for (const char* host : {"evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example",
                             "10.0.0.1", "[fd00::1]:8080", "127.0.0.1@evil.example", "example.org", "x"}) {
      EXPECT_EQ(answer_to(names, host), "host-not-served") << own << ": " << host;
    }
  }
}

TEST(ServedNames, AreAnyWhereOthersMayCall) {
  for (const char* own : {"0.0.0.0", "::", "10.0.0.1", "maps.example.org"}) {
    EXPECT_EQ(answer_to({own, {}}, "anything.example"), "no error") << own;
  }
}

TEST(ServedNames, AreTheOnesToldAlsoWhereOthersMayCall) {
  for (const char* own : {"0.0.0.0", "::", "10.0.0.1", "Roadfix.lan"}) {
    const ServedNames names(own, {"maps.example.org", "10.0.0.2"});
    for (const char* host :
         {"localhost:8080", "127.0.0.1:8080", "[::1]:8080", "", "maps.example.org", "10.0.0.2:8080"}) {
      EXPECT_EQ(answer_to(names, host), "no error") << own << ": " << host;
    }
    for (const char* host : {"evil.example", "10.0.0.3", "maps.example.org.evil.example"}) {
      EXPECT_EQ(answer_to(names, host), "host-not-served") << own << ": " << host;
    }
  }
  for (const char* host : {"10.0.0.1:8080", "10.0.0.1"}) {
    EXPECT_EQ(answer_to({"10.0.0.1", {"maps.example.org"}}, host), "no error") << "where it listens";
  }
}

TEST(ServedNames, HaveNoPortAndNoScheme) {
  for (const char* name : {"", "a:80", "http://a", "a/", "*"}) {
    EXPECT_EQ(code_of([&] { ServedNames("127.0.0.1", {name}); }), "bad-server-name") << name;
  }
}

std::string answer_to(const std::string& method, const std::string& site, const std::string& cors_origin) {
  Request request;
  request.method = method;
  request.headers = {{"sec-fetch-site", site}, {"origin", "https://a.example"}};
  return code_of([&] { require_same_site(request, cors_origin); });
}

TEST(SameSite, IsAskedForOnlyWhereSomethingChangesAndNoOriginIsLetIn) {
  for (const char* method : {"POST", "DELETE"}) {
    EXPECT_EQ(answer_to(method, "cross-site", ""), "cross-site-request");
    EXPECT_EQ(answer_to(method, "cross-site", "https://b.example"), "cross-site-request");
    for (const char* let_in : {"https://a.example", "*"}) {
      EXPECT_EQ(answer_to(method, "cross-site", let_in), "no error");
    }
    for (const char* site : {"same-origin", "same-site", "none", ""})
      EXPECT_EQ(answer_to(method, site, ""), "no error");
  }
  EXPECT_EQ(answer_to("GET", "cross-site", ""), "no error") << "a page reads no answer that does not open to it";
}

class HttpServerOrigins : public testing::HttpServerTest {};

TEST_F(HttpServerOrigins, AnswersToItsOwnNamesAndToProxiesThatAreNamed) {
  settings_.names = ServedNames(settings_.host, {});
  const httplib::Headers rebound{{"Host", "evil.example"}};
  {
    const auto server = started();
    EXPECT_EQ(client().Get("/echo?text=a")->body, "a");
    EXPECT_EQ(client().Get("/echo?text=a", rebound)->body, "host-not-served");
    EXPECT_EQ(client().Post("/length", rebound, "abc", "text/plain")->body, "host-not-served");
    EXPECT_NE(raw("GET http://evil.example/echo HTTP/1.1\r\nHost: localhost\r\n\r\n").find("host-not-served"),
              std::string::npos);
  }
  settings_.proxies = Proxies({"127.0.0.1"});
  const auto server = started();
  EXPECT_EQ(client().Get("/echo?text=a", rebound)->body, "a");
}

TEST_F(HttpServerOrigins, TakesNothingFromPagesOfOtherSites) {
  const auto server = started();
  const httplib::Headers page{{"Sec-Fetch-Site", "cross-site"}, {"Origin", "https://evil.example"}};
  EXPECT_EQ(client().Post("/length", page, "abc", "text/plain")->body, "cross-site-request");
  EXPECT_EQ(client().Post("/length", "abc", "text/plain")->body, "3");
}

}  // namespace
}  // namespace roadfix::http
