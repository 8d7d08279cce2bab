// SPDX-License-Identifier: Apache-2.0
// Who may talk to the editor: only pages that it served itself, to whoever knows its token. Any page in the
// same browser can send requests to this machine, and so can its other users.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/server/http.h"

namespace cei3d {

class Guard {
 public:
  // allowed_hosts: names besides the loopback's that the browser may know this machine by.
  Guard(std::string token, std::vector<std::string> allowed_hosts = {});

  // 403: a foreign Host or Origin, or no token; 405, 415: a method or type of content that is never used.
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

// Headers of every response: nothing but the program's own files is loaded, shown or sent anywhere.
const std::vector<std::pair<std::string, std::string>>& safety_headers();

}  // namespace cei3d
