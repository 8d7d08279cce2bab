// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "core/base/error.h"
#include "core/base/file.h"

namespace cei3d {
namespace {

struct Options {
  std::string project, capture, json_file;
  bool json = false;
  EvalRequest request;
};

void evaluate(const Options& o, Session& session, Console& console) {
  EvalRequest request = o.request;
  if (request.truth.empty() != request.masks.empty() || (request.edit.empty() && !request.truth.empty()))
    fail_usage(
        "--truth and --mask belong together and to --edit: which edit, how it should look, and where it "
        "should "
        "be.");
  if (!o.capture.empty()) {
    const CaptureSpec spec = parse_capture_spec(o.capture);
    request.capture = spec.path;
    request.split = spec.split;
  }
  session.open(o.project, Session::Access::read);
  const EvalReport r = session.evaluate(request, console);
  if (!o.json_file.empty()) write_file_atomic(o.json_file, r.json().dump(1) + "\n");
  if (o.json) console.set_json(true);
  console.answer(r.json(), r.markdown());
}

}  // namespace

void add_networks(CLI::App* verb, NetworkFiles& files) {
  verb->add_option(
          "--lpips-model", files.lpips,
          "ONNX network for LPIPS: two pictures [1,3,H,W] in [-1,1] to one distance; docs/evaluation.md says "
          "how to get one (default: no LPIPS)")
      ->check(CLI::ExistingFile);
  verb->add_option("--fid-model", files.fid,
                   "ONNX network for FID: a picture [1,3,299,299] in [0,1] to its features (default: no FID)")
      ->check(CLI::ExistingFile);
}

void add_residual_switch(CLI::App* verb, bool& on) {
  verb->add_flag(
      "!--no-residual", on,
      "Light and material alone, without what was learned of the photographs besides (never used under "
      "another light, nor where an edit was made)");
}

void add_eval(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("eval",
                                "Compare rendered with real views: PSNR and SSIM, on white and inside the "
                                "object mask; LPIPS and FID with "
                                "networks of yours");
  verb->add_option("project", o->project, "Project folder")->required();
  verb->add_option("capture", o->capture,
                   "CAPTURE or CAPTURE:split (default: the project's own held-out views)");
  // Here --json may name a file; without one it is the flag that it is everywhere.
  verb->add_option_function<std::vector<std::string>>(
          "--json",
          [o](const std::vector<std::string>& values) {
            o->json = values.empty() || values[0].empty();
            if (!o->json) o->json_file = values[0];
          },
          "Write the scores to this file as JSON; without a file: print them")
      ->expected(0, 1);
  verb->add_option("--samples", o->request.samples,
                   "Sub-pixel samples per axis, twice as many where the silhouette passes")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  add_residual_switch(verb, o->request.residual);
  verb->add_option(
      "--edit", o->request.edit,
      "Also score this edit (an id of `log`): the area that it does not touch against the photographs");
  verb->add_option(
          "--truth", o->request.truth,
          "With --edit: folder of pictures of the edited object, named like the views: fidelity inside its "
          "mask, leakage outside")
      ->check(CLI::ExistingDirectory);
  verb->add_option("--mask", o->request.masks,
                   "With --edit: folder of masks, bright where the edit should be")
      ->check(CLI::ExistingDirectory);
  verb->add_option(
      "--pictures", o->request.pictures,
      "Folder of PNGs to write: photograph, render and, with --edit, edited render, side by side");
  add_networks(verb, o->request.networks);
  commands.on(verb, o, evaluate);
}

}  // namespace cei3d
