// SPDX-License-Identifier: BSD-3-Clause
// The sub-commands of the program and the CLI11 validators that they share.
#pragma once

#include <CLI/CLI.hpp>

namespace roomgraph {

// Each adds its sub-command to the application; the work happens in the sub-command's callback. A callback
// reports failure by throwing roomgraph::Error, whose exit code main() returns.
void addImportCommand(CLI::App& app);
void addExportCommand(CLI::App& app);
void addInfoCommand(CLI::App& app);
void addDamageCommand(CLI::App& app);
void addVaryCommand(CLI::App& app);
void addCalibrateCommand(CLI::App& app);

void addOptimizeCommand(CLI::App& app);
void addRunCommand(CLI::App& app);
void addGraphSlamCommand(CLI::App& app);
void addReportCommand(CLI::App& app);
void addEvaluateCommand(CLI::App& app);
void addSnapshotCommand(CLI::App& app);
void addConfigReferenceCommand(CLI::App& app);
void addSimulateCommand(CLI::App& app);
void addTrainingSetCommand(CLI::App& app);
void addBenchCommand(CLI::App& app);
void addBatchCommand(CLI::App& app);
void addMapCommand(CLI::App& app);
void addModelsCommand(CLI::App& app);
void addViewCommand(CLI::App& app);
// These two describe all commands of `app`, also those added after them.
void addCompletionCommand(CLI::App& app);
void addManualCommand(CLI::App& app);

// Checks of numbers on the command line.
CLI::Validator atLeastZero();
CLI::Validator aboveZero();

/// "1280x960" of --size: width and height, px. Throws ConfigError.
std::pair<int, int> sizeInPixels(const std::string& text);

}  // namespace roomgraph
