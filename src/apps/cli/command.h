// SPDX-License-Identifier: Apache-2.0
// A command: options that CLI11 fills, and the function that runs with them.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/console.h"
#include "engine/session/session.h"

namespace cei3d {

struct CommonOptions {
  bool quiet = false, json = false;
  std::string log_level = "info";
  std::string device = "auto";
  int threads = 0;
};

// Runs another command line, without the program's name; returns its exit code.
using RunLine = std::function<int(const std::vector<std::string>&)>;

class Commands {
 public:
  Commands(CLI::App& app, const CommonOptions& common, RunLine run_line)
      : app_(app), common_(common), run_line_(std::move(run_line)) {}

  // Adds a command. parent: the command that it belongs to; null: the program.
  CLI::App* add(const std::string& name, const std::string& help, CLI::App* parent = nullptr) {
    CLI::App* verb = (parent ? parent : &app_)->add_subcommand(name, help);
    verb->fallthrough();  // so that --quiet, --json, ... may follow the command
    return verb;
  }
  // Sets what the command does. options: filled by CLI11, kept alive by the command.
  template <class Options, class F>
  void on(CLI::App* verb, std::shared_ptr<Options> options, F run) {
    verb->callback(
        [this, options, run] { run_ = [options, run](Session& s, Console& c) { run(*options, s, c); }; });
  }
  void run(Console& console) const {
    Session session(common_.device, common_.threads);
    run_(session, console);
  }
  const CLI::App& app() const { return app_; }
  const CommonOptions& common() const { return common_; }
  // Runs another command line with the options that every command has, such as --threads, as given to this
  // one.
  int run_line(const std::vector<std::string>& line) const { return run_line_(line); }
  bool chosen() const { return bool(run_); }

 private:
  CLI::App& app_;
  const CommonOptions& common_;
  RunLine run_line_;
  std::function<void(Session&, Console&)> run_;
};

void add_networks(CLI::App* verb, NetworkFiles&);    // --lpips-model, --fid-model
void add_residual_switch(CLI::App* verb, bool& on);  // --no-residual
void add_samples(CLI::App* verb, int& samples);      // --samples

void add_check(Commands&);
void add_capture(Commands&);
void add_reconstruct(Commands&);
void add_render(Commands&);
void add_edit(Commands&);
void add_parts(Commands&);
void add_history(Commands&);  // log, undo, redo, toggle, goto, rename, restore, forget, replay
void add_export(Commands&);
void add_eval(Commands&);
void add_evaluate(Commands&);
void add_info(Commands&);  // info, doctor
void add_bench(Commands&);
void add_batch(Commands&);
void add_open(Commands&);
void add_synth(Commands&);
void add_demo(Commands&);
void add_manual(Commands&);  // completion, manual

}  // namespace cei3d
