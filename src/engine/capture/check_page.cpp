// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/check_page.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/html.h"
#include "core/base/parallel.h"
#include "core/image/resample.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"
#include "engine/io/image_file.h"
#include "engine/io/jpeg_file.h"

namespace cei3d {
namespace {

constexpr Vec3f kRed{0.85f, 0.15f, 0.1f}, kGray{0.5f, 0.5f, 0.5f};

void put(Image& image, int x, int y, Vec3f color) { std::copy_n(&color.x, 3, image.at(x, y)); }

// A note asks for no change of a view.
bool is_doubtful(const View& view, const CaptureReport& report) {
  return std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& f) {
    return f.severity != Severity::note && f.marked &&
           std::find(f.views.begin(), f.views.end(), view.name) != f.views.end();
  });
}

std::vector<Image> pictures_of(const Capture& capture, const CaptureReport& report, int size) {
  std::vector<Image> all(capture.views.size());
  parallel_for(int(all.size()),
               [&](int i) { all[size_t(i)] = view_picture(capture.views[size_t(i)], report, size); });
  return all;
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t v = 0;
    for (size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[v >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string image_tag(const Image& image) {
  return fmt::format("<img src=\"data:image/jpeg;base64,{}\">", base64(encode_jpeg(image, 85)));
}

constexpr const char* kHead = R"(<!doctype html><meta charset="utf-8"><title>Check of a capture</title><style>
body{font:15px/1.45 sans-serif;margin:2em;max-width:75em;color:#222}
li{margin:.5em 0}.problem b{color:#b00}.warning b{color:#a60}.note b{color:#068}
figure{display:inline-block;margin:4px;vertical-align:top;width:180px}figcaption{font-size:12px;overflow-wrap:anywhere}
.doubtful img{outline:3px solid #d22}img{max-width:100%}
</style>)";

std::string finding_item(const Finding& f) {
  const char* word = f.severity == Severity::error     ? "problem"
                     : f.severity == Severity::warning ? "warning"
                                                       : "note";
  return fmt::format("<li class=\"{0}\"><b>{0}</b> {1} {2}</li>\n", word, html_escaped(f.what),
                     html_escaped(f.fix));
}

}  // namespace

Image view_picture(const View& view, const CaptureReport& report, int size) {
  Image rgba;
  try {
    rgba = load_linear_rgba(view);
  } catch (const Error&) {
    return Image(size, size, 3, kGray.x);
  }
  for (const CaptureReport::Doubt& d : report.doubts)
    for (size_t i = 0; d.view == view.name && i < d.area.size(); ++i)
      if (d.area[i]) rgba.data[4 * i + 3] = kUnknownAlpha;
  Image plain(rgba.width, rgba.height, 3);
  for (int y = 0; y < rgba.height; ++y)
    for (int x = 0; x < rgba.width; ++x) {
      const float alpha = rgba.at(x, y)[3];
      const Vec3f c = rgba.rgb(x, y);
      put(plain, x, y, alpha < 0 ? c * 0.4f + kRed * 0.6f : c * (0.15f + 0.85f * alpha));
    }
  const int n = std::max(1, std::max(rgba.width, rgba.height) / (2 * size));
  plain = downscale(plain, n);
  const double s = double(size) / std::max(plain.width, plain.height);
  return srgb_from_linear(
      scaled_to(plain, std::max(1, int(plain.width * s)), std::max(1, int(plain.height * s))));
}

Image contact_sheet(const Capture& capture, const CaptureReport& report, int size) {
  const std::vector<Image> pictures = pictures_of(capture, report, size);
  constexpr int kFrame = 4;
  const int cell = size + 2 * kFrame, n = int(pictures.size());
  const int columns = std::clamp(int(std::ceil(std::sqrt(n * 1.5))), 1, 16),
            rows = (n + columns - 1) / columns;
  Image sheet(columns * cell, std::max(rows, 1) * cell, 3, 1.0f);
  for (int i = 0; i < n; ++i) {
    const Image& p = pictures[size_t(i)];
    const int x0 = i % columns * cell, y0 = i / columns * cell;
    if (is_doubtful(capture.views[size_t(i)], report))
      for (int y = 0; y < p.height + 2 * kFrame; ++y)
        for (int x = 0; x < p.width + 2 * kFrame; ++x) put(sheet, x0 + x, y0 + y, kRed);
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) put(sheet, x0 + kFrame + x, y0 + kFrame + y, p.rgb(x, y));
  }
  return sheet;
}

std::string check_page(const Capture& capture, const CaptureReport& report) {
  std::string page = kHead;
  page += fmt::format("<h1>{}</h1><p>{} views, format {}. {}</p><ul>\n", html_escaped(capture.root.string()),
                      capture.views.size(), report.format,
                      report.usable() ? "Ready for <code>cei3d reconstruct</code>." : "Cannot be used yet.");
  for (const Finding& f : report.findings) page += finding_item(f);
  page += "</ul>\n";
  if (report.normalization)
    page +=
        "<p>Cameras and the object's bounding sphere from above and from the side; training blue, validation "
        "green, test orange.</p>" +
        image_tag(draw_cameras(capture, *report.normalization)) + "\n";
  page += "<h2>Views</h2><p>What is not the object is dark; where a mask is overruled it is red.</p>\n";
  const std::vector<Image> pictures = pictures_of(capture, report, 180);
  for (size_t i = 0; i < pictures.size(); ++i)
    page += fmt::format("<figure{}>{}<figcaption>{}</figcaption></figure>\n",
                        is_doubtful(capture.views[i], report) ? " class=\"doubtful\"" : "",
                        image_tag(pictures[i]), html_escaped(capture.views[i].name));
  return page;
}

}  // namespace cei3d
