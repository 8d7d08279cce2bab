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
    fail_usage("--truth and --mask need each other and --edit.");
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
  verb->add_option("--lpips-model", files.lpips,
                   "ONNX network for LPIPS, from two images [1,3,H,W] in [-1,1] to a distance; see "
                   "docs/evaluation.md (default: no LPIPS)")
      ->check(CLI::ExistingFile);
  verb->add_option(
          "--fid-model", files.fid,
          "ONNX network for FID, from an image [1,3,299,299] in [0,1] to its features (default: no FID)")
      ->check(CLI::ExistingFile);
}

void add_samples(CLI::App* verb, int& samples) {
  verb->add_option("--samples", samples, "Samples per pixel and axis; twice as many at the silhouette")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
}

void add_residual_switch(CLI::App* verb, bool& on) {
  verb->add_flag_callback(
      "--no-residual", [&on] { on = false; },
      "Light and material alone, without the correction by photographs (which is not used under other lights "
      "either)");
}

void add_eval(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("eval",
                                "Compare renders with photographs: PSNR and SSIM, on white and inside the "
                                "object mask; LPIPS and FID with networks that you supply");
  verb->add_option("project", o->project, "Project folder")->required();
  verb->add_option("capture", o->capture,
                   "CAPTURE or CAPTURE:split (default: the project's own held-out views)");
  // In this command --json may name a file. Without one it is the same flag as in other commands.
  verb->add_option_function<std::vector<std::string>>(
          "--json",
          [o](const std::vector<std::string>& values) {
            o->json = values.empty() || values[0].empty();
            if (!o->json) o->json_file = values[0];
          },
          "Write the scores as JSON to this file, or print them when no file is given")
      ->expected(0, 1);
  add_samples(verb, o->request.samples);
  add_residual_switch(verb, o->request.residual);
  verb->add_option(
      "--edit", o->request.edit,
      "Also score the area that this edit (an id of `log`) does not touch, against the photographs");
  verb->add_option("--truth", o->request.truth,
                   "With --edit and --mask: folder of true images of the edited object, named like the "
                   "views; scores fidelity inside the mask and leakage outside")
      ->check(CLI::ExistingDirectory);
  verb->add_option("--mask", o->request.masks,
                   "With --edit and --truth: folder of masks, bright where the edit should be")
      ->check(CLI::ExistingDirectory);
  verb->add_option(
      "--pictures", o->request.pictures,
      "Folder to write: photograph, render and, with --edit, edited render, side by side as PNG");
  add_networks(verb, o->request.networks);
  commands.on(verb, o, evaluate);
}

}  // namespace cei3d
