// SPDX-License-Identifier: BSD-3-Clause
// Entry point: command-line parsing, exit codes, and one line on stderr per error.
#include <fcntl.h>

#include <iostream>
#include <sstream>

#include "commands.h"
#include "program.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/core/unexpected.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph {
namespace {

// Messages of libraries may have line breaks; whoever reads our errors line by line must not lose a part.
std::string oneLine(const std::string& text) {
  std::istringstream in(text);
  std::string out;
  for (std::string word; in >> word;) out += (out.empty() ? "" : " ") + word;
  return out;
}

int fail(const std::string& message, int exit_code) {
  std::cerr << "roomgraph: " << oneLine(message) << "\n";
  return exit_code;
}

std::string problemOf(const CLI::App& app, const CLI::App& command, const CLI::ParseError& error) {
  const auto unknown = app.remaining(true);
  if (unknown.empty()) return error.what();
  if (&command != &app || unknown.front().starts_with("-"))
    return "unknown argument '" + unknown.front() + "'";
  std::vector<std::string> known;
  for (const auto* listed : app.get_subcommands({}))
    if (!listed->get_group().empty()) known.push_back(listed->get_name());
  return "unknown command '" + unknown.front() + "'" + didYouMean(unknown.front(), known) +
         "; known: " + join(known);
}

// One line: what is wrong, and the usage of the command that was meant.
int failUsage(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = &app;
  std::string name = app.get_name();
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    name += " " + command->get_name();
  }
  return fail(problemOf(app, *command, error) + ". " + CLI::Formatter().make_usage(command, name) +
                  " (more: " + name + " --help)",
              2);
}

// A file that is opened must never take the place of a closed standard stream: what is printed would go into
// it.
void holdStandardStreams() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor)
    while (fcntl(descriptor, F_GETFD) < 0 && open("/dev/null", O_RDWR) >= 0) {
    }
}

void addCommands(CLI::App& app) {
  addImportCommand(app);
  addExportCommand(app);
  addInfoCommand(app);
  addDamageCommand(app);
  addVaryCommand(app);
  addCalibrateCommand(app);
  addOptimizeCommand(app);
  addRunCommand(app);
  addEvaluateCommand(app);
  addSnapshotCommand(app);
  addReportCommand(app);
  addConfigReferenceCommand(app);
  addSimulateCommand(app);
  addTrainingSetCommand(app);
  addBenchCommand(app);
  addBatchCommand(app);
  addMapCommand(app);
  addModelsCommand(app);
  addViewCommand(app);
  addGraphSlamCommand(app);
  addCompletionCommand(app);
  addManualCommand(app);
}

int runCommand(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : failUsage(app, error);
  } catch (const Error& error) {
    return fail(error.what(), error.exit_code);
  } catch (const std::exception& error) {
    return fail(textOfUnexpected(error), 1);
  }
  return 0;
}

// What a command printed is a result too: on a full disk it is lost.
int flushOutput(int exit_code) {
  if (std::cout.flush()) return exit_code;
  const int failed = fail("standard output: writing failed (disk full?)", 1);
  return exit_code == 0 ? failed : exit_code;
}

int startProgram(int argc, char** argv) {
  CLI::App app{"Object-level semantic SLAM on MRPT rawlogs (RGB-D, 2D lidar, odometry).", "roomgraph"};
  app.set_version_flag("--version", std::string(kVersion) + " (" + kRevision + ")");
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 the run failed, 2 wrong usage or config, 3 input cannot be read, 4 interrupted "
      "(results cover what was done until then; an import writes nothing).\n"
      "All keys of the configuration: roomgraph config-reference.");
  observations::registerClasses();
  addCommands(app);
  return runCommand(app, argc, argv);
}

}  // namespace
}  // namespace roomgraph

int main(int argc, char** argv) {
  roomgraph::holdStandardStreams();
  roomgraph::tellOfShortagesInThreads("roomgraph");
  int exit_code = 1;
  try {
    exit_code = roomgraph::startProgram(argc, argv);
  } catch (const std::exception& error) {  // before there was a command: a machine without memory
    roomgraph::fail(roomgraph::textOfUnexpected(error), exit_code);
  }
  return roomgraph::flushOutput(exit_code);
}
