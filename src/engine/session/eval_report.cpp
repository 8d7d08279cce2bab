// SPDX-License-Identifier: Apache-2.0
// What `eval` answers, as JSON and as tables.
#include "core/base/error.h"
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
    rest["pixels"] = e.rest->pixels;
    rest["views"] = e.rest->views;
  }
  if (e.fid) j["fid_before_after"] = *e.fid;
  return j;
}

std::string edit_markdown(const EditScore& e) {
  std::string text;
  if (e.truth)
    text += fmt::format(
        "\n| edit: views | PSNR inside | IoU | pixels inside | changed outside | pixels outside |\n"
        "|---|---|---|---|---|---|\n| {} | {} dB | {:.3f} | {} | {} | {} |\n",
        e.truth->views, decibels_text(e.truth->psnr_inside), e.truth->iou, e.truth->pixels_inside,
        e.truth->changed_outside, e.truth->pixels_outside);
  if (e.rest)
    text += fmt::format(
        "\n| non-edited area: views | PSNR | SSIM |{} pixels |\n|---|---|---|{}---|\n| {} | {} dB | {:.4f} "
        "|{} {} |\n",
        e.rest->lpips ? " LPIPS |" : "", e.rest->lpips ? "---|" : "", e.rest->views,
        decibels_text(e.rest->psnr), e.rest->ssim,
        e.rest->lpips ? fmt::format(" {:.4f} |", *e.rest->lpips) : "", e.rest->pixels);
  if (e.fid) text += fmt::format("\nFID between the renders before and after the edit: {:.1f}\n", *e.fid);
  return text;
}

double decibels_from(const Json& j) { return j.is_number() ? j.get<double>() : INFINITY; }

std::optional<double> number_from(const Json& j, const char* key) {
  return j.contains(key) ? std::optional(j.at(key).get<double>()) : std::nullopt;
}

EditScore edit_from(const Json& j) {
  EditScore e;
  if (j.contains("psnr_inside"))
    e.truth = EditFidelity{decibels_from(j.at("psnr_inside")),   j.at("iou").get<double>(),
                           j.at("pixels_inside").get<size_t>(),  j.at("changed_outside").get<size_t>(),
                           j.at("pixels_outside").get<size_t>(), j.at("views").get<size_t>()};
  if (j.contains("non_edited")) {
    const Json& r = j.at("non_edited");
    e.rest = RestScore{decibels_from(r.at("psnr")), r.at("ssim").get<double>(), number_from(r, "lpips"),
                       r.at("pixels").get<size_t>(), r.at("views").get<size_t>()};
  }
  e.fid = number_from(j, "fid_before_after");
  return e;
}

ViewScore view_from(const Json& j) {
  ViewScore v{
      j.at("view").get<std::string>(), decibels_from(j.at("psnr")), j.at("ssim").get<double>(), {}, {}};
  if (!j.at("psnr_masked").is_null()) v.psnr_masked = decibels_from(j.at("psnr_masked"));
  v.lpips = number_from(j, "lpips");
  return v;
}

}  // namespace

EvalReport eval_report_from_json(const Json& j) {
  EvalReport r;
  r.psnr = decibels_from(j.at("psnr"));
  r.ssim = j.at("ssim").get<double>();
  r.psnr_masked = decibels_from(j.at("psnr_masked"));
  r.psnr_worst = decibels_from(j.at("psnr_worst"));
  r.worst_view = j.at("worst_view").get<std::string>();
  r.residual = j.value("residual", false);
  if (j.contains("alone"))
    r.alone = {decibels_from(j.at("alone").at("psnr")), decibels_from(j.at("alone").at("psnr_masked"))};
  r.lpips = number_from(j, "lpips");
  r.fid = number_from(j, "fid");
  if (j.contains("edit")) r.edit = edit_from(j.at("edit"));
  for (const Json& v : j.at("views")) r.views.push_back(view_from(v));
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
  if (alone) j["alone"] = {{"psnr", decibels(alone->psnr)}, {"psnr_masked", decibels(alone->psnr_masked)}};
  if (lpips) j["lpips"] = *lpips;
  if (fid) j["fid"] = *fid;
  if (edit) j["edit"] = edit_json(*edit);
  j["views"] = Json::array();
  for (const ViewScore& v : views) {
    Json view = {{"view", v.view},
                 {"psnr", decibels(v.psnr)},
                 {"ssim", v.ssim},
                 {"psnr_masked", v.psnr_masked ? decibels(*v.psnr_masked) : Json()}};
    if (v.lpips) view["lpips"] = *v.lpips;
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
  if (alone)
    column("light and material alone", fmt::format("{} dB, {} dB in the mask", decibels_text(alone->psnr),
                                                   decibels_text(alone->psnr_masked)));
  if (lpips) column("LPIPS", fmt::format("{:.4f}", *lpips));
  if (fid) column("FID", fmt::format("{:.1f}", *fid));
  std::string text = head + "\n" + rule + "\n" + row + "\n";
  if (fid)
    text += fmt::format(
        "\nFID between {} renders and as many photographs: so few bias it upwards; compare it with sets of "
        "the same "
        "size only.\n",
        views.size());
  text += residual ? "\nWith the correction network; --no-residual leaves it out.\n"
                   : "\nLight and material alone.\n";
  if (edit) text += edit_markdown(*edit);
  return text;
}

}  // namespace cei3d
