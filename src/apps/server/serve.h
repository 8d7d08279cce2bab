// SPDX-License-Identifier: Apache-2.0
// The live editor as a program: serves it until it is told to stop.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/server/editor.h"
#include "apps/server/http_server.h"

namespace cei3d {

struct ServeOptions {
  EditorOptions editor;
  HttpOptions http;
  std::vector<std::string> allowed_hosts;  // names of this machine that may stand in the address
};

struct Address {
  std::string url;     // with the key behind the #, which no server and no log sees
  std::string tunnel;  // the command that makes the address work on another machine
};

// announce: called once, when the address can be opened. stop: called ten times a second; true ends the
// editor. Errors: those of Editor and HttpServer; an address that other machines can reach, without
// allowed_hosts.
void serve(const ServeOptions&, const std::function<void(const Address&)>& announce,
           const std::function<bool()>& stop);

}  // namespace cei3d
