// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/demo_page.h"

#include "core/base/error.h"

namespace cei3d {
namespace {

constexpr const char* kHead =
    R"(<!doctype html><meta charset="utf-8"><title>CEI-3D demo</title>
<style>body{font:16px sans-serif;margin:2em;max-width:70em}div{display:flex;flex-wrap:wrap;gap:1em}
figure{margin:0}img{width:192px;background:#fff;border:1px solid #ddd}figcaption{font-size:80%}
iframe{width:100%;height:30em;border:1px solid #ddd}</style>
<h1>Spot: photographs to an editable object</h1>
<iframe src="spot.html" title="The painted object, live"></iframe>
)";

std::string figure(const std::string& file, const std::string& caption) {
  return fmt::format("<figure><img src=\"{}\"><figcaption>{}</figcaption></figure>\n", file, caption);
}

std::string row(const std::string& title, const std::string& figures) {
  return fmt::format("<h2>{}</h2><div>\n{}</div>\n", title, figures);
}

std::string size_text(uintmax_t bytes) {
  return bytes < 1000000 ? fmt::format("{:.0f} kB", double(bytes) / 1e3)
                         : fmt::format("{:.1f} MB", double(bytes) / 1e6);
}

std::string list_of(const std::vector<DemoFile>& files) {
  std::string items;
  for (const DemoFile& f : files)
    items += fmt::format("<li><a href=\"{0}\">{0}</a>: {1}; {2}</li>\n", f.name, f.what, size_text(f.bytes));
  return "<h2>The painted object as files</h2><ul>\n" + items + "</ul>\n";
}

}  // namespace

std::string demo_page(const std::vector<std::string>& views, const std::vector<std::string>& turntable,
                      const std::vector<DemoFile>& files) {
  std::string page = kHead + list_of(files);
  for (const std::string& view : views) {
    const std::string file = view + ".png";
    page += row("Reconstruction, view " + view,
                figure("photo_" + file, "photograph, held out") + figure("before/rgb/" + file, "our render") +
                    figure("before/albedo/" + file, "albedo") + figure("before/normal/" + file, "normals"));
    page += row("Edits, view " + view,
                figure("painted/rgb/" + file, "painted") + figure("painted/albedo/" + file, "its albedo") +
                    figure("relit/rgb/" + file, "another light") +
                    figure("turned/rgb/" + file, "the same light, turned by 90 degrees"));
  }
  std::string pictures;
  for (const std::string& name : turntable) pictures += figure("turntable/rgb/" + name + ".png", name);
  return page + row("Turntable", pictures);
}

}  // namespace cei3d
