// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph models`: list, fetch, check and path of networks for the detector.
#include <iostream>
#include <memory>
#include <optional>

#include "commands.h"
#include "interrupts.h"
#include "models_report.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/models/fetch.h"
#include "roomgraph/models/model_folder.h"
#include "shared_files.h"

namespace roomgraph {
namespace {

struct ModelsArguments {
  std::string models, catalogue, from, json;
  std::vector<std::string> names;
};

NetworkCatalogue catalogueOf(const ModelsArguments& a) {
  return NetworkCatalogue::fromFile(catalogueFileOf(a.catalogue));
}

std::filesystem::path folderFor(const ModelsArguments& a) {
  const auto models = modelFolder(a.models);
  if (models.empty())
    throw ConfigError("there is neither $XDG_DATA_HOME nor $HOME: name a folder with --models");
  return models;
}

/// Progress on stderr: one line that is rewritten, or without a terminal a plain line per file.
class FetchProgress : public FetchListener {
 public:
  explicit FetchProgress(bool quiet) : quiet_(quiet) {}
  void started(const KnownFile& file) override {
    line_.emplace(quiet_ ? nullptr : &std::cerr, file.name, "MB", static_cast<double>(file.bytes) / 1e6);
  }
  void progressed(std::uint64_t bytes) override { line_->update(static_cast<double>(bytes) / 1e6); }
  void finished(const KnownFile& file, bool was_there) override {
    if (!was_there) line_->finish(file.name + ": " + std::to_string(file.bytes) + " bytes, checksum right");
    line_.reset();
  }
  bool cancelled() const override { return interrupted(); }
  /// Ends a line that is being rewritten, before an error is printed.
  void end() {
    if (line_) line_->finish();
  }

 private:
  bool quiet_;
  std::optional<Progress> line_;
};

void listNetworks(const ModelsArguments& a) {
  const auto catalogue = catalogueOf(a);
  const auto models = folderFor(a);
  if (!a.json.empty()) writeFileAtomically(a.json, networksJson(catalogue, models));
  if (a.names.empty()) {
    std::cout << networkTable(catalogue, models);
    return;
  }
  std::string text;
  for (const auto& name : a.names) text += describeNetwork(catalogue.network(name), models);
  std::cout << text;
}

void fetchAll(const ModelsArguments& a, bool quiet) {
  const auto catalogue = catalogueOf(a);
  const auto models = folderFor(a);
  for (const auto& name : a.names) (void)catalogue.network(name);
  catchInterrupts();
  FetchProgress progress(quiet);
  for (const auto& name : a.names) {
    const auto& network = catalogue.network(name);
    try {
      fetchNetwork(network, models, a.from, progress);
    } catch (const Error&) {
      progress.end();
      throw;
    }
    std::cout << name << ": " << networkFile(network, models).string() << std::endl;
  }
}

void checkNetworks(const ModelsArguments& a) {
  const auto catalogue = catalogueOf(a);
  const auto models = folderFor(a);
  std::vector<KnownNetwork> wanted;
  for (const auto& name : a.names) wanted.push_back(catalogue.network(name));
  for (const auto& network : catalogue.networks())
    if (a.names.empty() && isBegun(network, models)) wanted.push_back(network);
  if (wanted.empty()) std::cout << "no network in " << models.string() << "\n";
  std::vector<std::string> wrong;
  for (const auto& network : wanted) {
    const auto faults = faultsOf(network, models);
    for (const auto& fault : faults) std::cout << fault << "\n";
    if (faults.empty()) std::cout << network.name << ": sizes and checksums are right\n";
    if (!faults.empty()) wrong.push_back(network.name);
  }
  if (!wrong.empty())
    throw RunError("not as they should be: " + join(wrong) + "; 'roomgraph models fetch " + join(wrong, " ") +
                   "' puts that right");
}

void printPath(const ModelsArguments& a) {
  const auto catalogue = catalogueOf(a);
  const auto& network = catalogue.network(a.names.front());
  const auto models = folderFor(a);
  if (!isInstalled(network, models))
    throw RunError(network.name + ": not installed in " + models.string() + "; 'roomgraph models fetch " +
                   network.name + "' does that");
  std::cout << networkFile(network, models).string() << "\n";
}

std::shared_ptr<ModelsArguments> addFolders(CLI::App& command) {
  auto a = std::make_shared<ModelsArguments>();
  command.add_option("--models", a->models,
                     "model folder (default: roomgraph/models in $XDG_DATA_HOME or ~/.local/share)");
  command.add_option("--catalogue", a->catalogue,
                     "catalogue of networks (default: the installed networks.json)");
  return a;
}

void addList(CLI::App& parent) {
  auto* command =
      parent.add_subcommand("list", "Known networks: what they find, cost, accuracy, where installed");
  auto a = addFolders(*command);
  command->add_option("NAME", a->names, "only these, with author, licence, files and checksums");
  command->add_option("--json", a->json, "also write all of it to this file");
  command->footer(
      "Examples:\n  roomgraph models list\n  roomgraph models list yolox-nano --json networks.json");
  command->callback([a] { listNetworks(*a); });
}

void addFetch(CLI::App& parent) {
  auto* command = parent.add_subcommand("fetch", "Download or copy networks into the model folder");
  auto a = addFolders(*command);
  auto quiet = std::make_shared<bool>(false);
  command->add_option("NAME", a->names, "networks")->required();
  command->add_option("--from", a->from,
                      "folder, or http(s) address of one, that holds the files, itself or in sub-folders "
                      "(default: where the authors publish them)");
  command->add_flag("--quiet", *quiet, "no progress");
  command->footer(
      "Examples:\n"
      "  roomgraph models fetch yolox-nano\n"
      "  roomgraph models fetch nanodet-plus-m-1.5x-416 deeplabv3-mnv2-ade20k --from /media/usb/models\n"
      "  https_proxy=http://proxy:3128 roomgraph models fetch yolo-fastest-1.1-xl\n"
      "A download that was broken off, also by Ctrl-C, is continued by the same command. A file gets its "
      "name "
      "when its SHA-256 is right.");
  command->callback([a, quiet] { fetchAll(*a, *quiet); });
}

void addCheck(CLI::App& parent) {
  auto* command = parent.add_subcommand("check", "Verify size and SHA-256 of installed networks");
  auto a = addFolders(*command);
  command->add_option("NAME", a->names, "only these (default: all that are installed)");
  command->footer("Examples:\n  roomgraph models check\n  roomgraph models check yolox-nano");
  command->callback([a] { checkNetworks(*a); });
}

void addPath(CLI::App& parent) {
  auto* command = parent.add_subcommand("path", "Print the file to name as detection.models");
  auto a = addFolders(*command);
  command->add_option("NAME", a->names, "network")->required()->expected(1);
  command->footer(
      "Example:\n"
      "  roomgraph run lab.rawlog -o out/lab --set detection.models=$(roomgraph models path yolox-nano)");
  command->callback([a] { printPath(*a); });
}

}  // namespace

void addModelsCommand(CLI::App& app) {
  auto* command = app.add_subcommand("models", "Networks for the detector: list, fetch, check, path");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  roomgraph models list\n"
      "  roomgraph models fetch yolox-nano\n"
      "  roomgraph models check\n"
      "  roomgraph models path yolox-nano\n"
      "'roomgraph run' uses what is installed when a recording holds no boxes and no network is named.");
  addList(*command);
  addFetch(*command);
  addCheck(*command);
  addPath(*command);
}

}  // namespace roomgraph
