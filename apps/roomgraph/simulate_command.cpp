// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph simulate`: synthetic recording of a described world or a random flat, with its ground truth.
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>

#include "commands.h"
#include "interrupts.h"
#include "thread_limit.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/simulation/flat.h"
#include "roomgraph/simulation/simulate.h"
#include "roomgraph/simulation/world_file.h"

namespace roomgraph {
namespace {

struct SimulateArguments {
  std::filesystem::path world, folder, meshes;
  std::optional<std::uint64_t> seed, flat;
  int rooms = 0, threads = 0;
  bool handheld = false, quiet = false;
};

/// The world, and its text when it was drawn.
std::pair<World, std::string> chosenWorld(const SimulateArguments& arguments) {
  if (!arguments.flat) return {readWorld(arguments.world), ""};
  const std::string text = flatText({*arguments.flat, arguments.rooms, arguments.handheld, arguments.meshes});
  return {parseWorld(text, "flat " + std::to_string(*arguments.flat)), text};
}

void simulateWorld(const SimulateArguments& arguments) {
  if (arguments.world.empty() == !arguments.flat)
    throw ConfigError("simulate needs a world file or --flat SEED, one of them");
  const ThreadLimit limit(arguments.threads);
  const auto [world, text] = chosenWorld(arguments);
  catchInterrupts();
  std::unique_ptr<Progress> line;
  SimulateOptions options;
  options.seed = arguments.seed.value_or(arguments.flat.value_or(1));
  options.world_text = text;
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
  auto* command = app.add_subcommand("simulate", "Make a recording of a described world or a random flat, with its truth");
  auto* world = command->add_option("WORLD", arguments->world, "world description (JSON)");
  command->add_option("-o,--output", arguments->folder, "folder for the rawlog and the truth files")
      ->required();
  command->add_option("--seed", arguments->seed,
                      "random seed of the noise: same seed, same bytes (default 1, or the number of the flat)");
  auto* flat = command->add_option("--flat", arguments->flat, "draw a flat with this number in place of WORLD")
                   ->excludes(world);
  command->add_option("--rooms", arguments->rooms, "of the flat, without corridors; 0: drawn")
      ->check(CLI::Range(0, 5))
      ->needs(flat);
  command->add_flag("--handheld", arguments->handheld, "the flat is seen by a camera in a hand, without robot")->needs(flat);
  command->add_option("--meshes", arguments->meshes,
                      "folder of worlds/extract_meshes.sh: some of the flat's chairs and sofas are catalogue models")
      ->check(CLI::ExistingDirectory)
      ->needs(flat);
  command->add_option("--threads", arguments->threads, "upper limit of threads; 0: all cores (the same bytes)")
      ->check(atLeastZero());
  command->add_flag("--quiet", arguments->quiet, "no progress");
  command->footer(
      "Examples:\n"
      "  roomgraph simulate worlds/lab.json -o data/lab\n"
      "  roomgraph simulate --flat 7 --rooms 3 -o data/flat_7\n"
      "A flat is described by data/flat_7/world.json, which makes the same recording with --seed 7.\n"
      "Ctrl-C ends the recording; what was simulated so far is complete, and the exit code is 4.");
  command->callback([arguments] { simulateWorld(*arguments); });
}

}  // namespace roomgraph
