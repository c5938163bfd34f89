// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph graphslam`: MRPT's graph-SLAM engine with its deciders and ours.
#include <dlfcn.h>

#include <cstdio>
#include <iostream>
#include <memory>

#include "commands.h"
#include "configuration.h"
#include "installed_networks.h"
#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/core/progress_file.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/graphslam/engine_run.h"
#include "roomgraph/pipeline/read_options.h"
#include "thread_limit.h"

namespace roomgraph {
namespace {

struct GraphSlamArguments {
  EngineRequest request;
  std::string config, progress;
  std::vector<std::string> overrides, poses;
  ModelSource networks;
  int threads = 0;
  bool list = false, quiet = false;
};

/// The function of the module with MRPT's engine, which needs a GUI library that nothing else here does.
RunEngine* loadEngine() {
#ifdef ROOMGRAPH_GRAPHSLAM
  void* module = dlopen(kEngineModule, RTLD_NOW | RTLD_LOCAL);
  if (!module) throw RunError(std::string("MRPT's engine cannot be loaded: ") + dlerror());
  auto* run = reinterpret_cast<RunEngine*>(dlsym(module, kRunEngine));
  if (!run) throw RunError(std::string(kEngineModule) + ": is not the engine of this program");
  return run;
#else
  throw RunError("this program was built without MRPT's engine, which needs the package libmrpt-graphslam-dev");
#endif
}

void list() {
  for (const auto& kind : deciderKinds())
    std::printf("%-20s %-9s %-6s %s\n", kind.name.c_str(),
                kind.role == DeciderRole::kNode   ? "node"
                : kind.role == DeciderRole::kEdge ? "edge"
                                                  : "optimizer",
                kind.in_3d ? "2D, 3D" : "2D", kind.what.c_str());
}

void print(const GraphSlamArguments& arguments, const EngineOutcome& outcome) {
  for (const auto& warning : outcome.warnings) std::cerr << "roomgraph: warning: " << warning << "\n";
  std::printf("%dD: %s, %s, %s\n%d records, %d nodes, %d edges, %d of them loop closures\nresults in %s\n",
              outcome.parts.dimensions, outcome.parts.node.c_str(), join(outcome.parts.edges, " + ").c_str(),
              outcome.parts.optimizer.c_str(), outcome.records, outcome.nodes, outcome.edges, outcome.closures,
              arguments.request.output.c_str());
  std::fflush(stdout);
}

void run(GraphSlamArguments& arguments) {
  if (arguments.list) return list();
  EngineRequest& request = arguments.request;
  if (request.rawlog.empty()) throw CLI::RequiredError("RAWLOG");
  if (request.ini.empty()) throw CLI::RequiredError("--ini");
  if (request.output.empty()) throw CLI::RequiredError("--output");
  const ThreadLimit limit(arguments.threads);
  Configuration configuration = readConfiguration(arguments.config, arguments.overrides);
  for (const auto& pose : arguments.poses) placeSensor(configuration.config, pose);
  request.make_setup = [&] { return makeRunSetup(configuration, request.rawlog, arguments.networks).setup; };
  Progress line(arguments.quiet ? nullptr : &std::cerr, "engine", "", 1);
  ProgressFile file(arguments.progress);
  request.progress = [&](double share) {
    line.update(share);
    file.update(share);
  };
  request.interrupted = interrupted;
  catchInterrupts();
  const EngineOutcome outcome = loadEngine()(request);
  line.finish();
  print(arguments, outcome);
  if (!outcome.interrupted) return;
  char text[96];
  std::snprintf(text, sizeof text, "interrupted: the results cover %.0f %% of the recording", 100 * outcome.share);
  throw Interrupted(text);
}

void addWindowOptions(CLI::App& command, EngineRequest& request) {
  auto* window = command.add_flag("--window", request.window, "show MRPT's window, until it is closed");
  command.add_option("--exit-after", request.exit_after_s, "close it so many seconds after the last record")
      ->check(atLeastZero())
      ->needs(window);
}

void addOptions(CLI::App& command, GraphSlamArguments& arguments) {
  EngineRequest& request = arguments.request;
  command.add_option("RAWLOG", request.rawlog, "rawlog of either format, plain or gzipped");
  command.add_option("--ini", request.ini, "ini of MRPT's graphslam-engine; may also name the parts, see below");
  command.add_option("-o,--output", request.output, "folder for the results");
  command.add_option("-n,--node-reg", request.asked.node,
                     "node registration decider (default: of the ini, else CFixedIntervalsNRD)");
  command.add_option("-e,--edge-reg", request.asked.edges,
                     "edge registration deciders, joined by + (default: of the ini, else CICPCriteriaERD)");
  command.add_option("-p,--optimizer", request.asked.optimizer, "optimizer (default: of the ini, else CLevMarqGSO)");
  command.add_option("--dimensions", request.asked.dimensions, "of the poses (default: of the ini, else 2)")
      ->check(CLI::IsMember({2, 3}));
  command.add_option("--truth", request.truth, "true path, lines 't x y phi', for the engine's own metric");
  command.add_flag("--list", arguments.list, "list the deciders and optimizers");
  command.add_option("--config", arguments.config, "for our parts: configuration (default: the installed config.ini)");
  command.add_option("--set", arguments.overrides, "for our parts: override, section.key=value; may be repeated");
  command.add_option("--pose", arguments.poses, "for our parts: place of a sensor, as in run; may be repeated");
  command.add_option("--models", arguments.networks.models, "for our parts: model folder, as in run");
  command.add_option("--threads", arguments.threads, "upper limit of threads; 0: all cores")->check(atLeastZero());
  addWindowOptions(command, request);
  command.add_flag("--verbose", request.verbose, "print what the engine and its parts log");
  command.add_option("--progress-file", arguments.progress,
                     "file that holds the share that is done, for programs that watch");
  command.add_flag("--quiet", arguments.quiet, "no progress");
}

}  // namespace

void addGraphSlamCommand(CLI::App& app) {
  auto arguments = std::make_shared<GraphSlamArguments>();
  auto* command = app.add_subcommand("graphslam", "Run MRPT's graph-SLAM engine, with its deciders or ours");
  addOptions(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  roomgraph graphslam --list\n"
      "  roomgraph graphslam simul.rawlog --ini odometry_2DRangeScans.ini -o out/stock\n"
      "  roomgraph graphslam lab.rawlog --ini share/mrpt/graphslam.ini -o out/ours\n"
      "  roomgraph graphslam lab.rawlog --ini share/mrpt/graphslam.ini -o out/mixed \\\n"
      "      -n CFixedIntervalsNRD -e CICPCriteriaERD+CScanClosuresERD -p CFactorGraphGSO\n"
      "  roomgraph graphslam lab.rawlog --ini share/mrpt/graphslam.ini -o out/3d --dimensions 3 \\\n"
      "      -e CImageClosuresERD\n"
      "  roomgraph graphslam lab.rawlog --ini share/mrpt/graphslam.ini -o out/seen --window\n"
      "Keys of [GeneralConfiguration] that graphslam-engine does not know: node_registration_decider,\n"
      "edge_registration_decider, optimizer, dimensions. What is written: docs/mrpt.md. Ctrl-C ends the\n"
      "replay; the results then cover what was replayed, and the exit code is 4.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roomgraph
