// SPDX-License-Identifier: Apache-2.0
// What `eval` answers, as JSON and as tables.
#include "core/base/error.h"
#include "core/base/json_reader.h"
#include "engine/session/number_text.h"
#include "engine/session/requests.h"

namespace cei3d {
namespace {

Json edit_json(const EditScore& e) {
  Json j = Json::object();
  if (e.truth)
    j = {{"psnr_inside", decibels(e.truth->psnr_inside)}, {"iou", e.truth->iou},
         {"pixels_inside", e.truth->pixels_inside},       {"changed_outside", e.truth->changed_outside},
         {"pixels_outside", e.truth->pixels_outside},     {"views", e.truth->views}};
  if (e.rest) {
    Json& rest = j["non_edited"] = {{"psnr", decibels(e.rest->psnr)}, {"ssim", e.rest->ssim}};
    if (e.rest->lpips) rest["lpips"] = *e.rest->lpips;
    if (e.rest->flip) rest["flip"] = *e.rest->flip;
    rest["pixels"] = e.rest->pixels;
    rest["views"] = e.rest->views;
  }
  if (e.fid) j["fid_before_after"] = *e.fid;
  return j;
}

std::string rest_markdown(const RestScore& r) {
  std::string head, rule, row;
  const auto column = [&](const char* name, const std::optional<double>& value) {
    if (!value) return;
    head += fmt::format(" {} |", name);
    rule += "---|";
    row += fmt::format(" {:.4f} |", *value);
  };
  column("SSIM", r.ssim);
  column("FLIP", r.flip);
  column("LPIPS", r.lpips);
  return fmt::format(
      "\n| non-edited area: views | PSNR |{} pixels |\n|---|---|{}---|\n| {} | {} dB |{} {} |\n", head, rule,
      r.views, decibels_text(r.psnr), row, r.pixels);
}

std::string edit_markdown(const EditScore& e) {
  std::string text;
  if (e.truth)
    text += fmt::format(
        "\n| edit: views | PSNR inside | IoU | pixels inside | changed outside | pixels outside |\n"
        "|---|---|---|---|---|---|\n| {} | {} dB | {:.3f} | {} | {} | {} |\n",
        e.truth->views, decibels_text(e.truth->psnr_inside), e.truth->iou, e.truth->pixels_inside,
        e.truth->changed_outside, e.truth->pixels_outside);
  if (e.rest) text += rest_markdown(*e.rest);
  if (e.fid) text += fmt::format("\nFID between the renders before and after the edit: {:.1f}\n", *e.fid);
  return text;
}

double decibels_from(const Json& j) { return j.is_number() ? j.get<double>() : INFINITY; }

double decibels_from(JsonReader& reader, const char* key) { return decibels_from(reader.member(key)); }

EditScore edit_from(JsonReader reader) {
  EditScore e;
  if (reader.has("psnr_inside"))
    e.truth =
        EditFidelity{decibels_from(reader, "psnr_inside"),     reader.require<double>("iou"),
                     reader.require<size_t>("pixels_inside"),  reader.require<size_t>("changed_outside"),
                     reader.require<size_t>("pixels_outside"), reader.require<size_t>("views")};
  if (reader.has("non_edited")) {
    JsonReader r = reader.object("non_edited");
    e.rest = RestScore{decibels_from(r, "psnr"),   r.require<double>("ssim"),   r.optional<double>("lpips"),
                       r.optional<double>("flip"), r.require<size_t>("pixels"), r.require<size_t>("views")};
    r.finish();
  }
  e.fid = reader.optional<double>("fid_before_after");
  reader.finish();
  return e;
}

ViewScore view_from(JsonReader reader) {
  ViewScore v{reader.require<std::string>("view"),
              decibels_from(reader, "psnr"),
              reader.require<double>("ssim"),
              {},
              {},
              {},
              {}};
  if (const Json& masked = reader.member("psnr_masked"); !masked.is_null())
    v.psnr_masked = decibels_from(masked);
  if (reader.has("psnr_exposed")) v.psnr_exposed = decibels_from(reader, "psnr_exposed");
  v.lpips = reader.optional<double>("lpips");
  v.flip = reader.optional<double>("flip");
  reader.finish();
  return v;
}

}  // namespace

EvalReport eval_report_from_json(const Json& j, const std::string& what) {
  JsonReader reader(j, what);
  EvalReport r;
  r.psnr = decibels_from(reader, "psnr");
  r.ssim = reader.require<double>("ssim");
  r.psnr_masked = decibels_from(reader, "psnr_masked");
  if (reader.has("psnr_exposed")) r.psnr_exposed = decibels_from(reader, "psnr_exposed");
  r.psnr_worst = decibels_from(reader, "psnr_worst");
  r.worst_view = reader.require<std::string>("worst_view");
  reader.has("background");  // always the same
  r.residual = reader.optional("residual", false);
  if (reader.has("alone")) {
    JsonReader alone = reader.object("alone");
    r.alone = {decibels_from(alone, "psnr"), decibels_from(alone, "psnr_masked")};
    alone.finish();
  }
  r.lpips = reader.optional<double>("lpips");
  r.fid = reader.optional<double>("fid");
  r.flip = reader.optional<double>("flip");
  if (reader.has("edit")) r.edit = edit_from(reader.object("edit"));
  for (const Json& v : reader.array("views")) r.views.push_back(view_from({v, "A view of " + what}));
  reader.finish();
  return r;
}

Json EvalReport::json() const {
  Json j = {{"psnr", decibels(psnr)},
            {"ssim", ssim},
            {"psnr_masked", decibels(psnr_masked)},
            {"psnr_worst", decibels(psnr_worst)},
            {"worst_view", worst_view},
            {"background", "white"},
            {"residual", residual}};
  if (psnr_exposed) j["psnr_exposed"] = decibels(*psnr_exposed);
  if (alone) j["alone"] = {{"psnr", decibels(alone->psnr)}, {"psnr_masked", decibels(alone->psnr_masked)}};
  if (lpips) j["lpips"] = *lpips;
  if (fid) j["fid"] = *fid;
  if (flip) j["flip"] = *flip;
  if (edit) j["edit"] = edit_json(*edit);
  j["views"] = Json::array();
  for (const ViewScore& v : views) {
    Json view = {{"view", v.view},
                 {"psnr", decibels(v.psnr)},
                 {"ssim", v.ssim},
                 {"psnr_masked", v.psnr_masked ? decibels(*v.psnr_masked) : Json()}};
    if (v.psnr_exposed) view["psnr_exposed"] = decibels(*v.psnr_exposed);
    if (v.lpips) view["lpips"] = *v.lpips;
    if (v.flip) view["flip"] = *v.flip;
    j["views"].push_back(std::move(view));
  }
  return j;
}

std::string EvalReport::markdown() const {
  std::string head = "| views | PSNR on white | worst view | SSIM | PSNR in the mask |",
              rule = "|---|---|---|---|---|";
  std::string row =
      fmt::format("| {} | {} dB | {} dB ({}) | {:.4f} | {} dB |", views.size(), decibels_text(psnr),
                  decibels_text(psnr_worst), worst_view, ssim, decibels_text(psnr_masked));
  const auto column = [&](const char* name, const std::string& value) {
    head += fmt::format(" {} |", name);
    rule += "---|";
    row += fmt::format(" {} |", value);
  };
  if (psnr_exposed) column("at the photographs' exposures", decibels_text(*psnr_exposed) + " dB");
  if (alone)
    column("light and material alone", fmt::format("{} dB, {} dB in the mask", decibels_text(alone->psnr),
                                                   decibels_text(alone->psnr_masked)));
  if (flip) column("FLIP", fmt::format("{:.4f}", *flip));
  if (lpips) column("LPIPS", fmt::format("{:.4f}", *lpips));
  if (fid) column("FID", fmt::format("{:.1f}", *fid));
  std::string text = head + "\n" + rule + "\n" + row + "\n";
  if (fid)
    text += fmt::format(
        "\nFID between {} renders and as many photographs: so few bias it upwards; compare it with sets of "
        "the same size only.\n",
        views.size());
  text += residual ? "\nWith the correction by photographs.\n" : "\nLight and material alone.\n";
  if (edit) text += edit_markdown(*edit);
  return text;
}

}  // namespace cei3d
