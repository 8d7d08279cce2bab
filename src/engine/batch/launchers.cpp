// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/launchers.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_reader.h"
#include "core/base/parse_json.h"
#include "core/base/process.h"
#include "core/base/system.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// A word of a shell.
std::string quoted(const fs::path& path) {
  std::string out = "'";
  for (const char c : path.string()) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

int megabytes(double gib) { return int(std::ceil(1024 * gib)); }

// Seconds before the limit at which a task is asked to save. Slurm may ask up to a minute earlier.
int warning_seconds(const ClusterRun& run) { return std::min(120, 60 * run.minutes / 3); }

size_t tasks(const ClusterRun& run, size_t first) {
  const size_t left = run.objects - first, pack = size_t(run.pack);
  return std::min(size_t(run.array_size), (left + pack - 1) / pack);
}

fs::path jobs_file(const fs::path& catalog) { return catalog / "slurm" / "jobs.json"; }

Json known_jobs(const fs::path& catalog) {
  std::error_code error;
  if (!fs::exists(jobs_file(catalog), error)) return Json::array();
  Json j = parse_json(read_file(jobs_file(catalog)));
  return j.is_array() ? j : Json::array();
}

std::string submit(const fs::path& script) {
  const ProgramOutput out = run_program({"sbatch", "--parsable", script.string()});
  if (out.exit_code != 0) fail("sbatch refuses {}: {}", script.string(), out.text);
  return out.text.substr(0, out.text.find_first_of(";\n"));  // "12;cluster"
}

constexpr const char* kTask = R"(
first=$(({first} + SLURM_ARRAY_TASK_ID * {pack}))
{program} batch work {manifest} -o {catalog} --index "$first:{pack}" --threads "$SLURM_CPUS_PER_TASK" --quiet &
pid=$!
trap 'kill -TERM "$pid"' TERM
# `wait` returns early when the signal comes; the worker saves and then ends.
wait "$pid"; code=$?
while kill -0 "$pid" 2>/dev/null; do wait "$pid"; code=$?; done
# 130: interrupted and saved. 75: a cause that may pass. More than 128: killed.
if {{ [ "$code" = 75 ] || [ "$code" -gt 128 ]; }} && [ ! -e {catalog}/cancelled ] &&
  [ "${{SLURM_RESTART_COUNT:-0}}" -lt {requeues} ]; then
  exec scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}"
fi
exit "$code"
)";

}  // namespace

std::string slurm_script(const ClusterRun& run, size_t first) {
  const size_t n = tasks(run, first);
  std::string head = "#!/bin/bash\n";
  const auto line = [&](const std::string& option) { head += "#SBATCH " + option + "\n"; };
  line("--job-name=cei3d-" + run.catalog.filename().string());
  line(fmt::format("--array=0-{}{}", n - 1, run.at_once > 0 ? fmt::format("%{}", run.at_once) : ""));
  line(fmt::format("--nodes=1 --ntasks=1 --cpus-per-task={} --mem={}M --time={}", run.threads,
                   megabytes(run.memory_gib), run.minutes));
  line(fmt::format("--requeue --open-mode=append --signal=B:TERM@{}", warning_seconds(run)));
  line(fmt::format("--output=\"{}\"", (run.catalog / "slurm" / "%A_%a.log").string()));
  if (!run.options.empty()) line(run.options);
  return head + fmt::format(kTask, fmt::arg("first", first), fmt::arg("pack", run.pack),
                            fmt::arg("program", quoted(run.program)),
                            fmt::arg("manifest", quoted(run.manifest)),
                            fmt::arg("catalog", quoted(run.catalog)), fmt::arg("requeues", run.requeues));
}

std::vector<std::string> submit_to_slurm(const ClusterRun& run, bool dry) {
  std::vector<std::string> out;
  Json jobs = known_jobs(run.catalog);
  const std::string time = utc_text("%Y%m%dT%H%M%S");
  for (size_t first = 0; first < run.objects; first += tasks(run, first) * size_t(run.pack)) {
    const fs::path script =
        run.catalog / "slurm" /
        fmt::format("{}-{}-{}.sh", time, run.manifest.stem().string().substr(0, 8), first);
    write_file_atomic(script, slurm_script(run, first));
    out.push_back(dry ? script.string() : submit(script));
    if (dry) continue;
    jobs.push_back(out.back());
    write_file_atomic(jobs_file(run.catalog), jobs.dump() + "\n");
  }
  return out;
}

size_t cancel_slurm_jobs(const fs::path& catalog) {
  const Json jobs = known_jobs(catalog);
  if (jobs.empty()) return 0;
  std::vector<std::string> command{"scancel"};
  for (const Json& job : jobs) command.push_back(job.get<std::string>());
  const ProgramOutput out = run_program(command);
  if (out.exit_code != 0) fail("scancel refuses: {}", out.text);
  write_file_atomic(jobs_file(catalog), "[]\n");
  return jobs.size();
}

std::string kubernetes_job(const ClusterRun& run) {
  constexpr const char* kJob = R"(apiVersion: batch/v1
kind: Job
metadata:
  name: cei3d-catalog
spec:
  completionMode: Indexed
  completions: {objects}
  parallelism: {at_once}
  backoffLimitPerIndex: 5       # Kubernetes 1.29 or newer
  maxFailedIndexes: {objects}
  podFailurePolicy:
    rules:
      - action: FailIndex       # 1: the capture cannot be used
        onExitCodes: {{containerName: cei3d, operator: In, values: [1, 2]}}
      - action: Ignore          # a node that goes away
        onPodConditions: [{{type: DisruptionTarget}}]
  template:
    spec:
      restartPolicy: Never
      terminationGracePeriodSeconds: 60
      containers:
        - name: cei3d
          image: cei3d:latest   # an image with cei3d in its path
          command: [sh, -c]
          args: ['exec cei3d batch work {manifest} -o {catalog} --index "$JOB_COMPLETION_INDEX" --threads {threads}']
          resources:
            requests: {{cpu: "{threads}", memory: {memory}Mi}}
            limits: {{memory: {memory}Mi}}
          volumeMounts: [{{name: catalog, mountPath: {parent}}}]
      volumes:
        - name: catalog         # the same folder on all nodes (ReadWriteMany), with the captures in it
          persistentVolumeClaim: {{claimName: catalog}}
)";
  const int at_once = run.at_once > 0 ? run.at_once : int(std::min<size_t>(run.objects, 100));
  return fmt::format(kJob, fmt::arg("objects", run.objects), fmt::arg("at_once", at_once),
                     fmt::arg("manifest", run.manifest.string()), fmt::arg("catalog", run.catalog.string()),
                     fmt::arg("threads", run.threads), fmt::arg("memory", megabytes(run.memory_gib)),
                     fmt::arg("parent", run.catalog.parent_path().string()));
}

std::string parallel_line(const ClusterRun& run) {
  return fmt::format(
      "seq 0 {} | parallel -j {} --retries 5 --joblog {} --resume-failed {} batch work {} -o {} --index {{}} "
      "--threads {}\n# on several machines: --sshloginfile NODES, one USER@HOST a line, with the same "
      "folders on all\n",
      run.objects - 1, run.at_once > 0 ? std::to_string(run.at_once) : "100%",
      quoted(run.catalog / "parallel.log"), quoted(run.program), quoted(run.manifest), quoted(run.catalog),
      run.threads);
}

}  // namespace cei3d
