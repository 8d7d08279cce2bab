// SPDX-License-Identifier: Apache-2.0
// HTTP messages and sockets as the editor sees them; apps/server/http_server.h carries them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cei3d {

struct HttpRequest {
  std::string method, path, query;  // path: as sent, without the query
  std::string host, origin, fetch_site, authorization, content_type, if_match, if_none_match;  // headers
  std::string body;

  // Value of a key of the query, decoded; none: not there.
  std::optional<std::string> parameter(const std::string& key) const;
};

struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers = {};
};

// Percent-encoding; none: malformed.
std::optional<std::string> decoded(const std::string& text);

// One WebSocket. Its methods may be called from any thread, also after it has closed.
class Socket {
 public:
  virtual ~Socket() = default;
  virtual void send(std::string text) = 0;
  // Bytes of a picture. group: those of another group that still wait are dropped, because a newer picture
  // takes their place.
  virtual void send_picture(std::string bytes, uint64_t group) = 0;
  virtual void close() = 0;
};
using SocketPtr = std::shared_ptr<Socket>;

// What answers. Called from the server's threads.
class HttpApp {
 public:
  virtual ~HttpApp() = default;
  // Before the body is read: the answer, if the request is refused.
  virtual std::optional<HttpResponse> refuse(const HttpRequest& head) = 0;
  virtual size_t body_limit(const HttpRequest& head) = 0;  // bytes
  // May reply later, from any thread, once.
  virtual void answer(HttpRequest, std::function<void(HttpResponse)> reply) = 0;
  virtual void opened(const SocketPtr&) = 0;
  virtual void received(const SocketPtr&, const std::string& text) = 0;
  virtual void closed(const SocketPtr&) = 0;
};

}  // namespace cei3d
