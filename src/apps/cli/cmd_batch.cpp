// SPDX-License-Identifier: Apache-2.0
// batch plan, run, work: catalogs of objects.
#include <algorithm>
#include <thread>

#include "apps/cli/batch_verbs.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/parse_json.h"
#include "core/base/system.h"
#include "engine/batch/launchers.h"
#include "engine/batch/local_engine.h"
#include "engine/batch/plan.h"
#include "engine/batch/status.h"
#include "engine/batch/work.h"

namespace cei3d {
namespace {

struct PlanOptions {
  std::vector<std::filesystem::path> captures;
  std::filesystem::path out;
  bool quick = false;
};

void plan(const PlanOptions& o, Session& session, Console& console) {
  const BatchPlan plan = batch_plan(o.captures, !o.quick, session, console);
  write_file_atomic(o.out, BatchManifest::of(plan.lines).text());
  for (const BatchRefusal& r : plan.refused) console.warn(fmt::format("{}: {}", r.id, r.reason));
  const std::string seen =
      o.quick ? ""
              : fmt::format(", {} views, at most {:.2f} GiB of memory each", plan.views, plan.memory_gib);
  console.done(plan.json(), fmt::format("{}: {} objects{}; {} would be refused.", o.out.string(),
                                        plan.lines.size(), seen, plan.refused.size()));
}

void add_plan(Commands& commands, CLI::App* batch) {
  auto o = std::make_shared<PlanOptions>();
  CLI::App* verb =
      commands.add("plan", "List captures as a manifest, one object a line, and check each", batch);
  verb->add_option("captures", o->captures,
                   "Captures, or one table: FILE.csv or FILE.jsonl (docs/cluster.md)")
      ->required()
      ->check(CLI::ExistingPath);
  verb->add_option("-o,--output", o->out, "Manifest to write, .jsonl")->required();
  verb->add_flag("--quick", o->quick, "Do not look into the captures");
  commands.on(verb, o, plan);
}

struct RunOptions {
  std::string manifest, catalog, engine = "local", memory = "2G", limit = "45m", slurm;
  std::string preset, time, steps, exports, purpose, keep;
  std::filesystem::path variants;
  int iterations = -1, retries = 3, jobs = 0, array_size = 1000, pack = 1;
  double beat = 10;
  int64_t seed = -1;
  bool dry = false;
};

double gib_of(const std::string& text) {
  size_t end = 0;
  double value = 0;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  const std::string unit = text.substr(std::min(end, text.size()));
  if (end == 0 || !(value > 0) || (unit != "G" && unit != "M" && !unit.empty()))
    fail_usage("--memory '{}': a number with G or M, as in 2G.", text);
  return unit == "M" ? value / 1024 : value;
}

Json words(const std::string& text) {
  Json out = Json::array();
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    out.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

// The values for all lines of the manifest that set no values of their own.
Json defaults_of(const RunOptions& o) {
  Json out = Json::object();
  if (!o.preset.empty()) out["options"]["preset"] = o.preset;
  if (!o.time.empty()) out["options"]["seconds"] = parse_duration(o.time);
  if (o.iterations >= 0) out["options"]["iterations"] = o.iterations;
  if (o.seed >= 0) out["options"]["seed"] = o.seed;
  if (!o.steps.empty()) out["steps"] = words(o.steps);
  if (!o.exports.empty()) out["export"] = words(o.exports);
  if (!o.purpose.empty()) out["for"] = o.purpose;
  if (!o.keep.empty()) out["keep"] = o.keep;
  if (o.variants.empty()) return out;
  out["variants"] = parse_json(read_file(o.variants));
  if (!out["variants"].is_object()) fail("{} is not a JSON object.", o.variants.string());
  return out;
}

// Indices of the objects that are still to be made: first those that get the given memory, then those that
// need more, because an attempt ran out of it.
std::vector<std::vector<size_t>> open_lines(const BatchCatalog& catalog, const BatchManifest& manifest) {
  std::vector<std::vector<size_t>> out(2);
  const std::vector<BatchItemStatus> items = batch_item_states(catalog, manifest);
  for (size_t i = 0; i < items.size(); ++i) {
    const auto& s = items[i].state;
    if (items[i].running || (s && s->outcome == BatchOutcome::done)) continue;
    out[s && s->memory_doublings > 0 ? 1 : 0].push_back(i);
  }
  return out;
}

ClusterRun cluster_run(const RunOptions& o, const BatchCatalog& catalog, const CommonOptions& common) {
  ClusterRun run;
  run.program = program_file();
  run.catalog = catalog.folder();
  run.threads = common.threads > 0 ? common.threads : 2;
  run.memory_gib = gib_of(o.memory);
  run.minutes = std::max(1, int(parse_duration(o.limit) / 60));
  run.at_once = o.jobs;
  run.array_size = o.array_size;
  run.pack = o.pack;
  run.options = o.slurm;
  return run;
}

void run_on_slurm(const RunOptions& o, const BatchCatalog& catalog, const BatchManifest& manifest,
                  ClusterRun run, Console& console) {
  Json jobs = Json::array();
  size_t objects = 0;
  for (const std::vector<size_t>& lines : open_lines(catalog, manifest)) {
    run.objects = lines.size();
    objects += lines.size();
    if (!lines.empty()) run.manifest = catalog.store(manifest.text_of(lines));
    for (const std::string& job : submit_to_slurm(run, o.dry)) jobs.push_back(job);
    run.memory_gib *= 2;
  }
  std::string text = fmt::format("{} objects in {} job arrays:", objects, jobs.size());
  for (const Json& job : jobs) text += " " + job.get<std::string>();
  console.done({{"objects", objects}, {"jobs", jobs}},
               text + fmt::format(". `cei3d batch status {}` says how far they are.", o.catalog));
}

void run_here(const RunOptions& o, const BatchCatalog& catalog, const CommonOptions& common,
              Console& console) {
  LocalRun run;
  run.program = program_file();
  run.manifest = catalog.manifest_file();
  run.threads = std::max(1, common.threads);
  const int cores = int(std::thread::hardware_concurrency());
  run.jobs = o.jobs > 0 ? o.jobs : std::max(1, cores / run.threads);
  run.memory_gib = gib_of(o.memory);
  const BatchRunReport r = run_locally(catalog, run, console);
  std::string text =
      fmt::format("{} of {} objects are done, after {}.", r.done, r.objects, duration_text(r.seconds));
  for (const std::string& object : r.not_done) text += "\n" + object;
  console.answer(r.json(), text);
  if (!r.not_done.empty())
    throw Error(ErrorCode::failed, fmt::format("{} of {} objects failed.", r.not_done.size(), r.objects));
}

void run(const RunOptions& o, const CommonOptions& common, Console& console) {
  BatchCatalog catalog(o.catalog);
  const BatchManifest manifest = BatchManifest::read(o.manifest);
  BatchSettings settings;
  settings.defaults = defaults_of(o);
  settings.retries = o.retries;
  settings.timing = {o.beat, 6 * o.beat};
  catalog.prepare(manifest, settings);
  ClusterRun cluster = cluster_run(o, catalog, common);
  cluster.manifest = catalog.manifest_file();
  cluster.objects = manifest.size();
  if (o.engine == "kubernetes")
    return console.answer({{"job", kubernetes_job(cluster)}}, kubernetes_job(cluster));
  if (o.engine == "parallel")
    return console.answer({{"line", parallel_line(cluster)}}, parallel_line(cluster));
  std::error_code ignored;
  std::filesystem::remove(batch_cancel_file(catalog.folder()), ignored);
  if (o.engine == "slurm") return run_on_slurm(o, catalog, manifest, cluster, console);
  if (!o.dry) return run_here(o, catalog, common, console);
  const size_t open = open_lines(catalog, manifest)[0].size();
  console.done({{"objects", open}}, fmt::format("{} of {} objects are to be made.", open, manifest.size()));
}

void add_objects_options(CLI::App* verb, RunOptions& o) {
  verb->add_option("--preset", o.preset, "Preset of every reconstruction, see `cei3d reconstruct -h`");
  CLI::Option* time =
      verb->add_option("--time", o.time, "Time for each reconstruction; its bits then depend on the load");
  verb->add_option("--iterations", o.iterations, "Steps of every geometry stage (default: the preset's)")
      ->excludes(time);
  verb->add_option("--seed", o.seed, "Random seed of every reconstruction (default: 1)");
  verb->add_option(
      "--steps", o.steps,
      "What to make, of check,reconstruct,figures,export,turntable; stub writes a small file, to try a "
      "launcher (default: check,reconstruct,figures,export)");
  verb->add_option("--export", o.exports,
                   "What to export, of glb,gltf,obj,usdz,ply,html,hdr,exr,npy,json (default: glb,html)");
  verb->add_option("--for", o.purpose, "What exports are for: web, ar, dcc");
  verb->add_option("--variants", o.variants,
                   "JSON file of edits to make on every object: {\"red\": [{\"edit\": \"material\", "
                   "\"part\": \"sole\", \"color\": \"#c04020\"}], ...}; each variant is exported, too")
      ->check(CLI::ExistingFile);
  verb->add_option("--keep", o.keep,
                   "What stays of an object that is done. all: every project. project: not those of "
                   "variants. exports: no project (default: project)")
      ->check(CLI::IsMember({"all", "project", "exports"}));
}

void add_engine_options(CLI::App* verb, RunOptions& o) {
  verb->add_option("--engine", o.engine,
                   "local: processes here, --threads each (default 1). slurm: submit job arrays. kubernetes, "
                   "parallel: print what an Indexed Job or GNU parallel needs")
      ->check(CLI::IsMember({"local", "slurm", "kubernetes", "parallel"}))
      ->capture_default_str();
  verb->add_option("--jobs", o.jobs,
                   "Objects at once (default: local: cores / --threads; else what the cluster gives)")
      ->check(CLI::PositiveNumber);
  verb->add_option("--memory", o.memory, "Memory of one object; one that ran out of it gets twice as much")
      ->capture_default_str();
  verb->add_option("--retries", o.retries,
                   "Attempts after the first one of an object whose worker was killed")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  verb->add_option("--limit", o.limit, "slurm: time of a task, after which it saves and is begun again")
      ->capture_default_str();
  verb->add_option("--slurm", o.slurm, "slurm: further options of sbatch, as in '-p cpu -A project'");
  verb->add_option("--array-size", o.array_size, "slurm: tasks of a job array")
      ->check(CLI::Range(1, 4000000))
      ->capture_default_str();
  verb->add_option("--pack", o.pack, "slurm: objects that one task makes, one after another")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  verb->add_option("--beat", o.beat,
                   "Seconds between the signs of life of a worker; after six without one others watch it, "
                   "and take over")
      ->check(CLI::Range(0.05, 3600.0))
      ->capture_default_str();
  verb->add_flag("--dry-run", o.dry, "Prepare the catalog, write scripts, start nothing");
}

void add_run(Commands& commands, CLI::App* batch) {
  auto o = std::make_shared<RunOptions>();
  CLI::App* verb = commands.add("run", "Make all objects of a manifest that are not made yet", batch);
  verb->add_option("manifest", o->manifest, "Manifest, .jsonl or .csv (docs/cluster.md)")
      ->required()
      ->check(CLI::ExistingFile);
  verb->add_option("-o,--output", o->catalog, "Folder of the catalog")->required();
  add_objects_options(verb, *o);
  add_engine_options(verb, *o);
  commands.on(verb, o, [&commands](const RunOptions& options, Session&, Console& console) {
    run(options, commands.common(), console);
  });
}

struct WorkOptions {
  std::string manifest, catalog, index, id;
  bool claim = false;
};

size_t whole_number(const std::string& text) {
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != text.npos)
    fail_usage("--index is a number, or FIRST:COUNT; '{}' is not.", text);
  return std::stoul(text);
}

std::vector<size_t> indices_of(const WorkOptions& o, const BatchManifest& manifest) {
  size_t first = 0, count = 1;
  if (!o.id.empty()) {
    while (first < manifest.size() && manifest.id(first) != o.id) ++first;
    if (first == manifest.size()) fail_usage("There is no object '{}' in {}.", o.id, o.manifest);
  } else {
    const size_t colon = o.index.find(':');
    first = whole_number(o.index.substr(0, colon));
    if (colon != o.index.npos) count = whole_number(o.index.substr(colon + 1));
  }
  if (first >= manifest.size())
    fail_usage("--index {}: {} has objects 0 to {}.", o.index, o.manifest, manifest.size() - 1);
  std::vector<size_t> out;
  for (size_t i = first; i < std::min(first + count, manifest.size()); ++i) out.push_back(i);
  return out;
}

std::vector<BatchWorkReport> reports_of(const WorkOptions& o, Session& session, Console& console) {
  const BatchCatalog catalog(o.catalog);
  const BatchManifest manifest = BatchManifest::read(o.manifest);
  if (o.claim) return batch_claim(catalog, manifest, session, console);
  std::vector<BatchWorkReport> out;
  for (const size_t i : indices_of(o, manifest)) {
    out.push_back(batch_work(catalog, manifest, i, session, console));
    if (out.back().result == BatchResult::interrupted) break;
  }
  return out;
}

// Ends with the highest exit code among the objects.
void work(const WorkOptions& o, Session& session, Console& console) {
  if (int(!o.index.empty()) + int(!o.id.empty()) + int(o.claim) != 1)
    fail_usage("Say which objects: --index I, --id ID or --claim.");
  Json list = Json::array();
  std::string text;
  const Error* worst = nullptr;
  std::vector<Error> errors;
  for (const BatchWorkReport& r : reports_of(o, session, console)) {
    list.push_back(r.json());
    text +=
        fmt::format("{}: {}{}\n", r.id, batch_result_name(r.result), r.reason.empty() ? "" : ", " + r.reason);
    const ErrorCode code = r.result == BatchResult::failed        ? ErrorCode::failed
                           : r.result == BatchResult::interrupted ? ErrorCode::interrupted
                                                                  : ErrorCode::again;
    if (r.result != BatchResult::done && r.result != BatchResult::up_to_date)
      errors.emplace_back(code, r.id + ": " + r.reason);
  }
  for (const Error& e : errors)
    if (worst == nullptr || int(e.code()) > int(worst->code())) worst = &e;
  console.done(list, text);
  if (worst != nullptr) throw Error(*worst);
}

void add_work(Commands& commands, CLI::App* batch) {
  auto o = std::make_shared<WorkOptions>();
  CLI::App* verb =
      commands.add("work",
                   "Make one object; safe to call from several schedulers at once and repeatedly. Exit "
                   "codes: 0 done, 1 failed and would fail again, 75 try again later, 130 "
                   "interrupted and saved",
                   batch);
  verb->add_option("manifest", o->manifest, "Manifest")->required()->check(CLI::ExistingFile);
  verb->add_option("-o,--output", o->catalog, "Folder of the catalog")->required();
  verb->add_option("--index", o->index,
                   "Line of the manifest, from 0; FIRST:COUNT: several, one after another");
  verb->add_option("--id", o->id, "Id of the object");
  verb->add_flag("--claim", o->claim, "Every object that no other worker is making, until none is left");
  commands.on(verb, o, work);
}

}  // namespace

void add_batch(Commands& commands) {
  CLI::App* batch = commands.add("batch", "Make catalogs of objects, here or on a cluster (docs/cluster.md)");
  batch->require_subcommand(1);
  add_plan(commands, batch);
  add_run(commands, batch);
  add_work(commands, batch);
  add_batch_looks(commands, batch);
}

}  // namespace cei3d
