// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph damage`: a copy of a rawlog with faults in it.
#include <iostream>

#include "bag_commands.h"
#include "commands.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/faults/damage.h"

namespace roomgraph {
namespace {

struct DamageArguments {
  std::filesystem::path input, output;
  std::uint64_t seed = 1;
  std::vector<std::pair<const CLI::Option*, std::string>> options;  ///< of the kinds of faults
};

// In the order of the command line.
std::vector<FaultRequest> requestsOf(const CLI::App& command, const DamageArguments& arguments) {
  std::vector<FaultRequest> requests;
  std::map<const CLI::Option*, std::size_t> taken;
  for (const CLI::Option* option : command.parse_order())
    for (const auto& [known, kind] : arguments.options)
      if (known == option) requests.push_back({kind, option->results().at(taken[option]++)});
  return requests;
}

std::string describe(const std::map<std::string, int>& counts) {
  std::vector<std::string> words;
  for (const auto& [label, count] : counts) words.push_back(std::to_string(count) + " '" + label + "'");
  return join(words);
}

void damage(const CLI::App& command, const DamageArguments& arguments) {
  const auto requests = requestsOf(command, arguments);
  if (requests.empty()) throw ConfigError("no fault is asked for; roomgraph damage --help lists them");
  ShareProgress progress("damage", arguments.output.string());
  const auto result =
      damageRawlog(arguments.input, arguments.output, requests, arguments.seed, progress.function());
  progress.finish();
  for (const auto& effect : result.effects)
    std::cout << effect.fault << ": " << describe(effect.counts) << "\n";
  for (const auto& [reason, count] : result.skipped)
    std::cout << "left out: " << count << " x " << reason << "\n";
  if (!result.truncation.empty())
    std::cerr << "roomgraph: warning: " << arguments.input.string() << ": " << result.truncation << "\n";
  std::cout << arguments.output.string() << ": " << result.written << " records of " << result.read << "\n";
}

}  // namespace

void addDamageCommand(CLI::App& app) {
  auto* command =
      app.add_subcommand("damage", "A copy of a rawlog with faults in it, for tests of robustness");
  auto a = std::make_shared<DamageArguments>();
  command->add_option("RAWLOG", a->input, "recording to copy; it stays as it is")->required();
  command->add_option("-o,--output", a->output, "rawlog to write (gzip inside)")->required();
  command->add_option("--seed", a->seed, "of what is random in faults (NaN, noise)")->capture_default_str();
  for (const auto& kind : faultKinds()) {
    auto* option = command->add_option("--" + kind.name, kind.what)->type_name(kind.value)->group("Faults");
    option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->allow_extra_args(false);
    a->options.emplace_back(option, kind.name);
  }
  command->footer(
      "A and B are seconds after the recording's first record, B excluded; A: means to the end. SENSOR is "
      "camera "
      "(with recorded detections), lidar or odometry; without it all are meant. Faults may be repeated; each "
      "gets what the one before it left. A fault that touches no record is an error.\n"
      "Examples:\n"
      "  roomgraph damage lab.rawlog -o dark.rawlog --black 10:20 --drop-lidar 15:25\n"
      "  roomgraph damage lab.rawlog -o late.rawlog --clock-jump camera=20:-1.5\n"
      "  roomgraph damage lab.rawlog -o bent.rawlog --wrong-extrinsics lidar=0,0,0,5,0,0\n"
      "  roomgraph damage lab.rawlog -o noisy.rawlog --noise lidar=10:12:2 --nan odometry=30:31 --seed 7\n"
      "What the program does with each: docs/faults.md.");
  command->callback([command, a] { damage(*command, *a); });
}

}  // namespace roomgraph
