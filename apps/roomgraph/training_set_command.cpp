// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph training-set`: labelled views of random flats, for training a detector.
#include <iostream>
#include <memory>

#include "commands.h"
#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/simulation/training_set.h"

namespace roomgraph {
namespace {

struct TrainingSetArguments {
  TrainingSetOptions options;
  std::string flats = "10000-10099", size = "320x240";
  std::filesystem::path folder, meshes, choice;
  bool quiet = false;
};

/// "A-B" or "AxB" as two numbers.
std::pair<std::uint64_t, std::uint64_t> twoNumbers(const std::string& text, char between) {
  const auto at = text.find(between);
  const auto digits = [](const std::string& part) {
    return !part.empty() && part.size() < 10 && part.find_first_not_of("0123456789") == std::string::npos;
  };
  const std::string first = text.substr(0, at), second = at == std::string::npos ? "" : text.substr(at + 1);
  if (!digits(first) || !digits(second))
    throw ConfigError("'" + text + "': two numbers with '" + between + "' between them are needed");
  return {std::stoull(first), std::stoull(second)};
}

void makeTrainingSet(TrainingSetArguments& arguments) {
  auto& options = arguments.options;
  std::tie(options.first_flat, options.last_flat) = twoNumbers(arguments.flats, '-');
  const auto [width, height] = twoNumbers(arguments.size, 'x');
  options.size = {static_cast<int>(width), static_cast<int>(height)};
  if (!arguments.choice.empty()) options.meshes = readMeshChoice(arguments.choice, arguments.meshes);
  catchInterrupts();
  Progress line(arguments.quiet ? nullptr : &std::cerr, "training-set", "flats",
                static_cast<double>(options.last_flat) - static_cast<double>(options.first_flat) + 1);
  options.progress = [&](double done, double) { line.update(done); };
  options.interrupted = interrupted;
  const auto result = writeTrainingSet(options, arguments.folder);
  line.finish();
  std::cout << arguments.folder.string() << ": " << result.views << " views of " << result.flats << " flats, "
            << result.boxes << " boxes\n";
  if (result.interrupted) throw Interrupted("interrupted: the set ends there");
}

}  // namespace

void addTrainingSetCommand(CLI::App& app) {
  auto arguments = std::make_shared<TrainingSetArguments>();
  auto* command =
      app.add_subcommand("training-set", "Render labelled views of random flats, to train a detector with");
  command->add_option("-o,--output", arguments->folder, "folder for views.u8, views.jsonl and set.json")
      ->required();
  command
      ->add_option("--flats", arguments->flats,
                   "numbers of the flats, FIRST-LAST; never 1000-1019, which are kept for reporting")
      ->capture_default_str();
  command->add_option("--views", arguments->options.views, "views tried of each flat")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT of the views, px")->capture_default_str();
  auto* meshes = command->add_option("--meshes", arguments->meshes, "folder of catalogue models")
                     ->check(CLI::ExistingDirectory);
  command
      ->add_option("--choice", arguments->choice,
                   "JSON file: which of them stand for what (training/meshes.json)")
      ->check(CLI::ExistingFile)
      ->needs(meshes);
  command->add_flag("--quiet", arguments->quiet, "no progress");
  command->footer(
      "Examples:\n"
      "  roomgraph training-set -o /data/train --flats 10000-10499\n"
      "  roomgraph training-set -o /data/check --flats 1-20 --views 20\n"
      "See training/README.md. Ctrl-C ends the set after the view at hand; it is complete, and the exit code "
      "is 4.");
  command->callback([arguments] { makeTrainingSet(*arguments); });
}

}  // namespace roomgraph
