// SPDX-License-Identifier: Apache-2.0
#include "apps/server/guard.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

const Guard guard("0123456789abcdef");

HttpRequest request(const std::string& method, const std::string& path) {
  HttpRequest r;
  r.method = method;
  r.path = path;
  r.host = "localhost:7861";
  r.authorization = "Bearer 0123456789abcdef";
  r.content_type = "application/json";
  return r;
}

int status(const HttpRequest& r) {
  const auto refusal = guard.refuse(r);
  return refusal ? refusal->status : 200;
}

struct Case {
  const char* what;
  void (*change)(HttpRequest&);
  int page, get, post;  // status of GET /, GET /api/state, POST /api/undo
};

const Case cases[] = {
    {"as it should be", [](HttpRequest&) {}, 200, 200, 200},
    {"by number", [](HttpRequest& r) { r.host = "127.0.0.1:80"; }, 200, 200, 200},
    {"by number 6", [](HttpRequest& r) { r.host = "[::1]:7861"; }, 200, 200, 200},
    {"no token", [](HttpRequest& r) { r.authorization = ""; }, 200, 401, 401},
    {"wrong token", [](HttpRequest& r) { r.authorization.back() = 'e'; }, 200, 401, 401},
    {"longer token", [](HttpRequest& r) { r.authorization += "0"; }, 200, 401, 401},
    {"token without Bearer", [](HttpRequest& r) { r.authorization = "0123456789abcdef"; }, 200, 401, 401},
    {"foreign host", [](HttpRequest& r) { r.host = "evil.example:7861"; }, 403, 403, 403},
    {"host that begins like ours", [](HttpRequest& r) { r.host = "localhost.evil.example"; }, 403, 403, 403},
    {"no host", [](HttpRequest& r) { r.host = ""; }, 403, 403, 403},
    {"own origin", [](HttpRequest& r) { r.origin = "http://localhost:7861"; }, 200, 200, 200},
    {"foreign origin", [](HttpRequest& r) { r.origin = "http://evil.example"; }, 403, 403, 403},
    {"other port", [](HttpRequest& r) { r.origin = "http://localhost:8888"; }, 403, 403, 403},
    {"no page", [](HttpRequest& r) { r.origin = "null"; }, 403, 403, 403},
    {"cross-site", [](HttpRequest& r) { r.fetch_site = "cross-site"; }, 200, 403, 403},
    {"same site, other port", [](HttpRequest& r) { r.fetch_site = "same-site"; }, 200, 403, 403},
    {"a form", [](HttpRequest& r) { r.content_type = "application/x-www-form-urlencoded"; }, 200, 200, 415},
    {"plain text", [](HttpRequest& r) { r.content_type = "text/plain"; }, 200, 200, 415},
};

TEST(Guard, LetsInItsOwnPagesOnly) {
  for (const Case& c : cases) {
    const std::pair<HttpRequest, int> wanted[] = {{request("GET", "/"), c.page},
                                                  {request("GET", "/api/state"), c.get},
                                                  {request("POST", "/api/undo"), c.post}};
    for (auto [r, code] : wanted) {
      c.change(r);
      EXPECT_EQ(status(r), code) << c.what << ": " << r.method << ' ' << r.path;
    }
  }
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT"})
    EXPECT_EQ(status(request(method, "/api/state")), 405) << method;
}

TEST(Guard, NamesTheHostsThatItsUserAllows) {
  HttpRequest r = request("GET", "/api/state");
  r.host = "box.lab:7861";
  EXPECT_TRUE(guard.refuse(r));
  EXPECT_FALSE(Guard("0123456789abcdef", {"box.lab"}).refuse(r));
}

TEST(Guard, TokensAreLongAndDifferent) {
  EXPECT_EQ(new_token().size(), 64u);
  EXPECT_NE(new_token(), new_token());
}

TEST(Guard, QueriesAreDecoded) {
  HttpRequest r;
  r.query = "a=1&name=my%20sky.hdr&bad=%zz";
  EXPECT_EQ(r.parameter("name"), "my sky.hdr");
  EXPECT_EQ(r.parameter("a"), "1");
  EXPECT_FALSE(r.parameter("bad"));
  EXPECT_FALSE(r.parameter("other"));
}

}  // namespace
}  // namespace cei3d
