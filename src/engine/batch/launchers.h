// SPDX-License-Identifier: Apache-2.0
// Job scripts for catalogs on many machines. Schedulers decide where and when an object is made; the files of
// the catalog say which objects are done.
#pragma once

#include "engine/batch/manifest.h"

namespace cei3d {

struct ClusterRun {
  std::filesystem::path program, manifest, catalog;
  size_t objects = 0;     // number of objects in the manifest
  int threads = 2;        // threads per task, which are its cores, too
  double memory_gib = 2;  // memory per task, GiB
  // Time limit of a task. Shortly before it the task is asked to save; it is then started again.
  int minutes = 45;
  int at_once = 0;  // maximum number of tasks at a time; 0: as many as the cluster gives
  // Maximum number of tasks per job array. Slurm's own limit, MaxArraySize, is 1001 unless it was raised.
  int array_size = 1000;
  int pack = 1;         // objects per task, made one after another
  int requeues = 20;    // how often a task that was interrupted is queued again, at most
  std::string options;  // further options of sbatch
};

// The script of a job array for the objects from `first` on.
std::string slurm_script(const ClusterRun&, size_t first);
// Stores all scripts that the manifest needs in CATALOG/slurm, and submits them unless `dry`. Returns the job
// numbers, or the files. Error: sbatch refuses.
std::vector<std::string> submit_to_slurm(const ClusterRun&, bool dry);
// Cancels the jobs of submit_to_slurm(). Returns their number.
size_t cancel_slurm_jobs(const std::filesystem::path& catalog);

// To be printed: a manifest of a Kubernetes Indexed Job, a line for GNU parallel.
std::string kubernetes_job(const ClusterRun&);
std::string parallel_line(const ClusterRun&);

}  // namespace cei3d
