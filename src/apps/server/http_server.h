// SPDX-License-Identifier: Apache-2.0
// HTTP/1.1 and WebSocket on one port, by Boost.Beast.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "apps/server/http.h"

namespace cei3d {

struct HttpOptions {
  std::string host = "127.0.0.1";  // address to listen at
  int port = 7861;                 // 0: any free one
  bool next_if_taken = true;       // if the port is taken, try those after it
};

class HttpServer {
 public:
  // Starts to listen. app: must outlive this. Errors: the address cannot be used, the port is taken, the
  // program was built without Boost.
  HttpServer(HttpApp& app, const HttpOptions&);
  ~HttpServer();  // closes everything

  int port() const;
  // Serves until stop(), which is called ten times a second, returns true.
  void run(const std::function<bool()>& stop);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cei3d
