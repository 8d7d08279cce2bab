// SPDX-License-Identifier: Apache-2.0
// HTTP messages and sockets as the editor sees them; HttpServer (apps/server/http_server.h) transfers them.
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

  // Decoded value of a key of the query; none: the key is missing, or its value is malformed.
  std::optional<std::string> parameter(const std::string& key) const;
};

struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers = {};
};

// Text without its percent-encoding; none: malformed.
std::optional<std::string> decoded(const std::string& text);

// One WebSocket. Its methods may be called from any thread, also after it has closed.
class Socket {
 public:
  virtual ~Socket() = default;
  virtual void send(std::string text) = 0;
  // Bytes of a picture. group: names the picture. Queued bytes of other groups are dropped, because this
  // newer picture replaces theirs.
  virtual void send_picture(std::string bytes, uint64_t group) = 0;
  virtual void close() = 0;
};
using SocketPtr = std::shared_ptr<Socket>;

// The application behind an HttpServer, called from the threads of the server.
class HttpApp {
 public:
  virtual ~HttpApp() = default;
  // Called before the body is read. The answer, if the request is refused.
  virtual std::optional<HttpResponse> refuse(const HttpRequest& head) = 0;
  virtual size_t body_limit(const HttpRequest& head) = 0;  // bytes
  // Calls `reply` once, now or later, from any thread.
  virtual void answer(HttpRequest, std::function<void(HttpResponse)> reply) = 0;
  virtual void opened(const SocketPtr&) = 0;
  virtual void received(const SocketPtr&, const std::string& text) = 0;
  virtual void closed(const SocketPtr&) = 0;
};

}  // namespace cei3d
