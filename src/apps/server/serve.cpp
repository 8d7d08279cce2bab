// SPDX-License-Identifier: Apache-2.0
#include "apps/server/serve.h"

#include "core/base/error.h"
#include "core/base/system.h"

namespace cei3d {
namespace {

bool is_loopback(const std::string& host) { return host == "127.0.0.1" || host == "::1"; }

// The number and not the name: `localhost` may also mean ::1, where another user of this machine could listen
// at the same port and be sent the key.
std::string loopback_of(const std::string& host) { return host == "::1" ? "[::1]" : "127.0.0.1"; }

std::string host_of_url(const ServeOptions& o) {
  return is_loopback(o.http.host) ? loopback_of(o.http.host) : o.allowed_hosts.front();
}

}  // namespace

void serve(const ServeOptions& options, const std::function<void(const Address&)>& announce,
           const std::function<bool()>& stop) {
  if (!is_loopback(options.http.host) && options.allowed_hosts.empty())
    fail_usage(
        "--host {} can be reached from other machines, and what is sent is not encrypted. An ssh tunnel to "
        "this machine's own address is safer; if you mean it, name this machine with --allow-host, too.",
        options.http.host);
  Guard guard(new_token(), options.allowed_hosts);
  const std::string token = guard.token();
  Editor editor(options.editor, std::move(guard));
  HttpServer server(editor, options.http);
  const std::string address = fmt::format("http://{}:{}", host_of_url(options), server.port());
  editor.say_address(address);
  announce(
      {fmt::format("{}/#k={}", address, token),
       fmt::format("ssh -L {0}:{1}:{0} {2}", server.port(), loopback_of(options.http.host), machine_name())});
  server.run(stop);
  editor.stop();
}

}  // namespace cei3d
