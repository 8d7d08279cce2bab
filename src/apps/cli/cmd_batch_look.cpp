// SPDX-License-Identifier: Apache-2.0
// batch status, retry, cancel, index: look after a catalog that is being made.
#include <chrono>
#include <thread>

#include "apps/cli/batch_verbs.h"
#include "apps/cli/parse.h"
#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/parallel.h"
#include "engine/batch/index.h"
#include "engine/batch/launchers.h"

namespace cei3d {
namespace {

struct Options {
  std::string catalog, id;
  std::filesystem::path out;
  bool watch = false, failed = false;
};

std::string status_text(const BatchStatus& s, bool failed) {
  std::string text = fmt::format("{} objects: {} done, {} failed, {} running, {} waiting", s.objects, s.done,
                                 s.failed, s.running, s.waiting);
  if (s.interrupted > 0) text += fmt::format(", {} interrupted", s.interrupted);
  if (s.retryable > 0) text += fmt::format(", {} to be tried again", s.retryable);
  text += s.cancelled ? "; cancelled\n" : "\n";
  if (s.per_hour > 0)
    text +=
        fmt::format("{:.1f} an hour, {} left; {:.2f} hours of work, the longest {} ({}); up to {:.2f} GiB\n",
                    s.per_hour, duration_text(3600 * s.hours_left), s.core_hours,
                    duration_text(s.slowest_seconds), s.slowest, s.peak_memory_gib);
  constexpr size_t kFew = 10;
  const size_t shown = failed ? s.failures.size() : std::min(kFew, s.failures.size());
  for (size_t i = 0; i < shown; ++i) text += s.failures[i] + "\n";
  if (shown < s.failures.size())
    text += fmt::format("... and {} more: --failed\n", s.failures.size() - shown);
  return text;
}

void status(const Options& o, Session& session, Console& console) {
  const BatchCatalog catalog(o.catalog);
  while (true) {
    const BatchStatus s = session.threads().run(
        [&] { return batch_status(catalog, BatchManifest::read(catalog.manifest_file())); });
    console.answer(s.json(), status_text(s, o.failed));
    if (!o.watch || s.done + s.failed == s.objects) return;
    constexpr int kPauses = 100;  // of 0.1 s, so that Ctrl-C is noticed at once
    for (int i = 0; i < kPauses; ++i) {
      check_cancelled(console, "Stopped watching; the work on the catalog goes on.");
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
}

void retry(const Options& o, Session& session, Console& console) {
  const BatchCatalog catalog(o.catalog);
  const size_t n = session.threads().run(
      [&] { return batch_retry(catalog, BatchManifest::read(catalog.manifest_file()), o.id); });
  console.done({{"objects", n}}, fmt::format("{} failed objects may be tried again: `cei3d batch run`.", n));
}

void cancel(const Options& o, Session&, Console& console) {
  const BatchCatalog catalog(o.catalog);
  catalog.manifest_file();  // throws if the folder is not a catalog
  write_file_atomic(batch_cancel_file(catalog.folder()), "");
  const size_t jobs = cancel_slurm_jobs(catalog.folder());
  console.done({{"slurm_jobs", jobs}},
               fmt::format("Workers save and stop within {:g} seconds; `cei3d batch run` goes on.{}",
                           catalog.settings().timing.beat,
                           jobs > 0 ? fmt::format(" {} job arrays of Slurm were cancelled.", jobs) : ""));
}

void index(const Options& o, Session& session, Console& console) {
  const BatchCatalog catalog(o.catalog);
  const size_t n = session.threads().run(
      [&] { return write_batch_index(catalog, BatchManifest::read(catalog.manifest_file()), o.out); });
  console.done({{"objects", n}, {"file", o.out.string()}}, fmt::format("{}: {} objects.", o.out.string(), n));
}

CLI::App* add_verb(Commands& commands, CLI::App* batch, const std::shared_ptr<Options>& o, const char* name,
                   const char* help) {
  CLI::App* verb = commands.add(name, help, batch);
  verb->add_option("catalog", o->catalog, "Folder of the catalog")->required()->check(CLI::ExistingDirectory);
  return verb;
}

}  // namespace

void add_batch_looks(Commands& commands, CLI::App* batch) {
  auto s = std::make_shared<Options>();
  CLI::App* verb = add_verb(commands, batch, s, "status", "Count what is done, running, waiting and failed");
  verb->add_flag("--watch", s->watch, "Every 10 seconds, until nothing is left to do");
  verb->add_flag("--failed", s->failed, "Every failure with its reason");
  commands.on(verb, s, status);

  auto r = std::make_shared<Options>();
  verb = add_verb(commands, batch, r, "retry",
                  "Let objects that failed for good be tried again by the next `run`");
  verb->add_flag("--failed", r->failed, "All of them (the default)");
  verb->add_option("--id", r->id, "Only this object");
  commands.on(verb, r, retry);

  auto c = std::make_shared<Options>();
  verb = add_verb(commands, batch, c, "cancel", "Ask all workers, wherever they run, to save and stop");
  commands.on(verb, c, cancel);

  auto i = std::make_shared<Options>();
  verb = add_verb(commands, batch, i, "index", "Write a table of all objects, worst first");
  verb->add_option("-o,--output", i->out, "File to write: .html with thumbnails and links, .json or .csv")
      ->required();
  commands.on(verb, i, index);
}

}  // namespace cei3d
