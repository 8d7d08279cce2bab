// SPDX-License-Identifier: Apache-2.0
// Catalogs on many machines: what schedulers are told. They decide where and when an object is made; the
// files of the catalog say what is done.
#pragma once

#include "engine/batch/manifest.h"

namespace cei3d {

struct ClusterRun {
  std::filesystem::path program, manifest, catalog;
  size_t objects = 0;     // of the manifest
  int threads = 2;        // and cores of each task
  double memory_gib = 2;  // of each task
  int minutes = 45;       // that a task may take before it is asked to save, and then begun again
  int at_once = 0;        // tasks, at most; 0: as many as the cluster gives
  int array_size = 1000;  // of a job array; Slurm's own limit, MaxArraySize, is 1001 unless it was raised
  int pack = 1;           // objects that one task makes, one after another
  int requeues = 20;      // of a task that was interrupted
  std::string options;    // further options of sbatch
};

// The script of a job array for the objects from `first` on.
std::string slurm_script(const ClusterRun&, size_t first);
// All scripts that the manifest needs, stored in CATALOG/slurm and submitted unless `dry`. Returns their job
// numbers, or the files. Error: sbatch refuses.
std::vector<std::string> submit_to_slurm(const ClusterRun&, bool dry);
// Cancels the jobs of submit_to_slurm() that are not over. Returns how many were asked.
size_t cancel_slurm_jobs(const std::filesystem::path& catalog);

// To be printed: a manifest of a Kubernetes Indexed Job, a line for GNU parallel.
std::string kubernetes_job(const ClusterRun&);
std::string parallel_line(const ClusterRun&);

}  // namespace cei3d
