// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph simulate`: synthetic recording of a described world with its ground truth.
#include <iomanip>
#include <iostream>
#include <memory>

#include "commands.h"
#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/simulation/simulate.h"
#include "roomgraph/simulation/world_file.h"

namespace roomgraph {
namespace {

struct SimulateArguments {
  std::filesystem::path world, folder;
  std::uint64_t seed = 1;
  bool quiet = false;
};

void simulateWorld(const SimulateArguments& arguments) {
  const World world = readWorld(arguments.world);
  catchInterrupts();
  std::unique_ptr<Progress> line;
  SimulateOptions options;
  options.seed = arguments.seed;
  options.interrupted = interrupted;
  options.progress = [&](double done, double total) {
    if (!line)
      line = std::make_unique<Progress>(arguments.quiet ? nullptr : &std::cerr, "simulate", "s", total);
    line->update(done);
  };
  const SimulateResult result = simulate(world, arguments.folder, options);
  if (line) line->finish();
  std::cout << result.rawlog.string() << ": " << std::setprecision(4) << result.seconds << " s, "
            << result.frames << " RGB-D frames, " << result.scans << " scans, " << result.odometry
            << " odometry readings, " << result.detections << " detection records\n"
            << arguments.folder.string() << ": truth of " << result.objects << " objects\n";
  if (result.interrupted) throw Interrupted("interrupted: recording and truth end there");
}

}  // namespace

void addSimulateCommand(CLI::App& app) {
  auto arguments = std::make_shared<SimulateArguments>();
  auto* command = app.add_subcommand("simulate", "Make a recording of a described world, with its truth");
  command->add_option("WORLD", arguments->world, "world description (JSON)")->required();
  command->add_option("-o,--output", arguments->folder, "folder for the rawlog and the truth files")
      ->required();
  command->add_option("--seed", arguments->seed, "random seed: same seed, same bytes")->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "no progress");
  command->footer(
      "Example:\n"
      "  roomgraph simulate worlds/lab.json -o data/lab\n"
      "Ctrl-C ends the recording; what was simulated so far is complete, and the exit code is 4.");
  command->callback([arguments] { simulateWorld(*arguments); });
}

}  // namespace roomgraph
