// SPDX-License-Identifier: Apache-2.0
#include "apps/server/guard.h"

#include <algorithm>
#include <random>

#include "core/base/error.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

constexpr const char* kBearer = "Bearer ";

// "localhost:7861" to "localhost", "[::1]:7861" to "[::1]".
std::string without_port(const std::string& host) {
  const size_t end = host.starts_with('[') ? host.find(']') : std::string::npos;
  const size_t colon = host.find(':', end == std::string::npos ? 0 : end);
  return host.substr(0, colon);
}

bool changes(const HttpRequest& r) { return r.method != "GET" && r.method != "HEAD"; }

bool is_api(const HttpRequest& r) { return r.path.starts_with("/api/"); }

}  // namespace

Guard::Guard(std::string token, std::vector<std::string> allowed_hosts)
    : token_(std::move(token)), hosts_(std::move(allowed_hosts)) {
  hosts_.insert(hosts_.end(), {"localhost", "127.0.0.1", "[::1]"});
}

bool Guard::own_host(const std::string& host) const {
  return std::find(hosts_.begin(), hosts_.end(), without_port(host)) != hosts_.end();
}

bool Guard::knows(std::string_view token) const {
  if (token.size() != token_.size()) return false;
  unsigned char different = 0;
  for (size_t i = 0; i < token.size(); ++i) different |= (unsigned char)(token[i] ^ token_[i]);
  return different == 0;
}

std::optional<HttpResponse> Guard::refuse(const HttpRequest& r) const {
  if (!own_host(r.host))
    return error_response(403, "This address is not one of the editor's.",
                          "Open the address that cei3d printed, or name this one with --allow-host.");
  if (!r.origin.empty() && r.origin != "http://" + r.host && r.origin != "https://" + r.host)
    return error_response(403, "Another page sent this request.");
  if ((changes(r) || is_api(r)) && !r.fetch_site.empty() && r.fetch_site != "same-origin" &&
      r.fetch_site != "none")
    return error_response(403, "Another page sent this request.");
  if (changes(r) && r.method != "POST") return error_response(405, "There is no such method here.");
  if (!is_api(r)) return std::nullopt;
  if (!r.authorization.starts_with(kBearer) ||
      !knows(std::string_view(r.authorization).substr(std::string_view(kBearer).size())))
    return error_response(401, "This page does not have the editor's key.",
                          "Open the whole address that cei3d printed, with what follows the #.");
  if (changes(r) && r.content_type != "application/json" && r.content_type != "application/octet-stream")
    return error_response(415, "The editor takes JSON and bytes only.");
  return std::nullopt;
}

std::string new_token() {
  std::random_device device;  // the system's generator
  std::string token;
  for (int i = 0; i < 8; ++i) token += fmt::format("{:08x}", uint32_t(device()));
  return token;
}

HttpResponse error_response(int status, const std::string& sentence, const std::string& hint) {
  Json j = {{"error", sentence}};
  if (!hint.empty()) j["hint"] = hint;
  return {status, "application/json", j.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

const std::vector<std::pair<std::string, std::string>>& safety_headers() {
  static const std::vector<std::pair<std::string, std::string>> headers = {
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
       "frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-origin"}};
  return headers;
}

}  // namespace cei3d
