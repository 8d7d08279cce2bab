// SPDX-License-Identifier: Apache-2.0
#include "engine/page/object_page.h"

#include "core/base/error.h"
#include "core/base/html.h"
#include "core/base/json.h"
#include "engine/io/gzip.h"
#include "engine/page/page_files.h"

namespace cei3d {
namespace {

// What a policy calls an inline script or style, so that no other is run or applied.
std::string hash_source(const PageFile& file) {
  std::string bytes;
  for (size_t i = 0; i < file.sha256.size(); i += 2)
    bytes.push_back(char(std::stoi(std::string(file.sha256.substr(i, 2)), nullptr, 16)));
  return "'sha256-" + base64(bytes) + "'";
}

// JSON that holds no tag.
std::string json_block(const Json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    out += c == '<' ? "\\u003c" : std::string(1, c);
  return out;
}

std::string block(const std::string& id, const char* type, const std::string& content) {
  return "<script id=\"data-" + id + "\" type=\"" + type + "\">" + content + "</script>\n";
}

// Replaces every {{name}} of the template.
class Filled {
 public:
  explicit Filled(std::string_view text) : rest_(text) {}

  std::string with(const std::vector<std::pair<std::string_view, std::string_view>>& values) {
    std::string out;
    for (size_t at; (at = rest_.find("{{")) != rest_.npos;) {
      const size_t end = rest_.find("}}", at);
      out += rest_.substr(0, at);
      out += value_of(values, rest_.substr(at + 2, end - at - 2));
      rest_ = rest_.substr(end + 2);
    }
    return out += rest_;
  }

 private:
  static std::string_view value_of(const std::vector<std::pair<std::string_view, std::string_view>>& values,
                                   std::string_view name) {
    for (const auto& [key, value] : values)
      if (key == name) return value;
    fail("page.html: no value for {}", name);
  }

  std::string_view rest_;
};

}  // namespace

const PageFile& page_file(std::string_view name) {
  for (const PageFile& f : page_files())
    if (f.name == name) return f;
  fail("The program holds no page file {}.", name);
}

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](size_t k) { return i + k < bytes.size() ? uint32_t(uint8_t(bytes[i + k])) : 0u; };
    const uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (int digit = 0; digit < 4; ++digit)
      out += i + size_t(digit) > bytes.size() ? '=' : kDigits[three >> (18 - 6 * digit) & 63];
  }
  return out;
}

std::string object_page(const std::string& title, const Json& about, const std::vector<PageData>& data) {
  const PageFile &script = page_file("page.joined.js"), &style = page_file("page.css");
  const std::string policy = "default-src 'none'; script-src " + hash_source(script) + "; style-src " +
                             hash_source(style) + "; base-uri 'none'; form-action 'none'";
  std::string blocks = block("about", "application/json", json_block(about));
  for (const PageData& d : data) blocks += block(d.name, "application/octet-stream", base64(gzip(d.bytes)));
  const std::string name = html_escaped(title);
  return Filled(page_file("page.html").bytes)
      .with({{"policy", policy},
             {"name", name},
             {"style", style.bytes},
             {"data", blocks},
             {"script", script.bytes}});
}

}  // namespace cei3d
