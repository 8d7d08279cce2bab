// SPDX-License-Identifier: Apache-2.0
// Who may use the editor: only pages that it served itself, and only with its token. The check is needed
// because any page in the same browser, and any user of this machine, can send requests to the editor.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/server/http.h"

namespace cei3d {

class Guard {
 public:
  // allowed_hosts: names of this machine, besides those of the loopback, that may stand in the address.
  Guard(std::string token, std::vector<std::string> allowed_hosts = {});

  // The refusal, if there is one. 403: a foreign Host or Origin, or no token; 405, 415: a method or type of
  // content that the page never uses.
  std::optional<HttpResponse> refuse(const HttpRequest&) const;
  bool knows(std::string_view token) const;  // takes the same time for every token of one length
  const std::string& token() const { return token_; }

 private:
  bool own_host(const std::string& host) const;

  std::string token_;
  std::vector<std::string> hosts_;
};

std::string new_token();  // 256 random bits, as 64 hexadecimal digits

// An error as the client shows it: {"error": sentence, "hint": what to do}.
HttpResponse error_response(int status, const std::string& sentence, const std::string& hint = {});

// Headers of every response. With them the browser lets the page load files from the program alone, and lets
// no other page embed or read it.
const std::vector<std::pair<std::string, std::string>>& safety_headers();

}  // namespace cei3d
