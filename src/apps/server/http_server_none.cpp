// SPDX-License-Identifier: Apache-2.0
// In place of http_server.cpp in builds without the editor's server (CEI3D_SERVER=OFF).
#include "apps/server/http_server.h"
#include "core/base/error.h"

namespace cei3d {

struct HttpServer::State {};

HttpServer::HttpServer(HttpApp&, const HttpOptions&) {
  fail("This cei3d was built without the editor; build it with -DCEI3D_SERVER=ON, which needs libboost-dev.");
}
HttpServer::~HttpServer() = default;
int HttpServer::port() const { return 0; }
void HttpServer::run(const std::function<bool()>&) {}

}  // namespace cei3d
