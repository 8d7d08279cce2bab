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
    j = {{"psnr_inside", decibels(e.truth->psnr_inside)},
         {"pixels_inside", e.truth->pixels_inside},
         {"changed_outside", e.truth->changed_outside},
         {"pixels_outside", e.truth->pixels_outside},
         {"views", e.truth->views}};
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
        "\n| edit: views | PSNR inside | pixels inside | changed outside | pixels outside |\n"
        "|---|---|---|---|---|\n| {} | {} dB | {} | {} | {} |\n",
        e.truth->views, decibels_text(e.truth->psnr_inside), e.truth->pixels_inside, e.truth->changed_outside,
        e.truth->pixels_outside);
  if (e.rest)
    text += fmt::format(
        "\n| non-edited area: views | PSNR | SSIM |{} pixels |\n|---|---|---|{}---|\n| {} | {} dB | {:.4f} "
        "|{} {} |\n",
        e.rest->lpips ? " LPIPS |" : "", e.rest->lpips ? "---|" : "", e.rest->views,
        decibels_text(e.rest->psnr), e.rest->ssim,
        e.rest->lpips ? fmt::format(" {:.4f} |", *e.rest->lpips) : "", e.rest->pixels);
  if (e.fid) text += fmt::format("\nFID between the pictures before and after the edit: {:.1f}\n", *e.fid);
  return text;
}

}  // namespace

Json EvalReport::json() const {
  Json j = {{"psnr", decibels(psnr)},
            {"ssim", ssim},
            {"psnr_masked", decibels(psnr_masked)},
            {"psnr_worst", decibels(psnr_worst)},
            {"worst_view", worst_view},
            {"background", "white"}};
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
  if (lpips) column("LPIPS", fmt::format("{:.4f}", *lpips));
  if (fid) column("FID", fmt::format("{:.1f}", *fid));
  std::string text = head + "\n" + rule + "\n" + row + "\n";
  if (fid)
    text += fmt::format(
        "\nFID between {} renders and as many photographs: so few bias it upwards; compare it with sets of "
        "the same "
        "size only.\n",
        views.size());
  if (edit) text += edit_markdown(*edit);
  return text;
}

}  // namespace cei3d
