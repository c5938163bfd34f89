// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph optimize`: least-squares solution of a 2D or 3D pose graph in g2o format.
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "commands.h"
#include "roomgraph/backend/g2o_file.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"

namespace roomgraph {
namespace {

struct OptimizeArguments {
  std::filesystem::path graph, output;
  int max_iterations = 100;
  bool keep_start = false, quiet = false;
};

SolveReport optimize(FactorGraph& graph, const SolveOptions& options) {
  return graph.optimize(options);
}
double chiSquared(const FactorGraph& graph) {
  return graph.chiSquared();
}
bool initializePoses(FactorGraph& graph) {
  return graph.initializePoses();
}
void saveG2o(const FactorGraph& graph, const std::filesystem::path& file, const NodeTimes& times) {
  graph.saveG2o(file, times);
}
std::string describe(const FactorGraph& graph) {
  return "3D, " + std::to_string(graph.poses()) + " poses, " + std::to_string(graph.landmarks()) +
         " landmarks, " + std::to_string(graph.factors()) + " edges";
}
std::string describe(const PlanarGraph& graph) {
  return "2D, " + std::to_string(graph.poses.size() - graph.landmarks.size()) + " poses, " +
         (graph.landmarks.empty() ? "" : std::to_string(graph.landmarks.size()) + " landmarks, ") +
         std::to_string(graph.edges.size()) + " edges";
}

std::string decimal(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4f", value);
  return text;
}

template <class Graph>
void run(Graph& graph, const NodeTimes& times, const OptimizeArguments& arguments) {
  const double before = chiSquared(graph);
  if (!std::isfinite(before))
    throw InputError(arguments.graph.string() + ": chi2 cannot be computed: its numbers are too large");
  std::cout << arguments.graph.string() << ": " << describe(graph) << "\n"
            << "chi2 before " << decimal(before) << std::endl;
  if (!arguments.keep_start && initializePoses(graph))
    std::cout << "chi2 of the chordal start " << decimal(chiSquared(graph)) << std::endl;
  Progress line(arguments.quiet ? nullptr : &std::cerr, "optimize", "iterations", 0);
  SolveOptions options{arguments.max_iterations, 1e-12};
  options.progress = [&](int iteration, double cost) { line.update(iteration, "chi2 " + decimal(2 * cost)); };
  const SolveReport report = optimize(graph, options);
  line.finish();
  const double after = chiSquared(graph);
  if (!report.usable || !std::isfinite(after))
    throw RunError(arguments.graph.string() + ": cannot be optimised: " + report.message);
  saveG2o(graph, arguments.output, times);
  const int steps = std::max(0, report.iterations - 1);  // the solver counts the start, too
  std::cout << "chi2 after  " << decimal(after) << " (" << steps << " iterations"
            << (steps >= arguments.max_iterations ? ", as many as --max-iterations allows: it may go lower" : "") << ")\n"
            << arguments.output.string() << ": written\n";
}

void optimizeFile(const OptimizeArguments& arguments) {
  G2oContent content = loadG2o(arguments.graph);
  for (const auto& [tag, lines] : content.skipped)
    std::cerr << "roomgraph: warning: " << arguments.graph.string() << ": " << lines << " lines '" << tag
              << "' skipped\n";
  std::visit([&](auto& graph) { run(graph, content.times, arguments); }, content.graph);
}

}  // namespace

void addOptimizeCommand(CLI::App& app) {
  auto arguments = std::make_shared<OptimizeArguments>();
  auto* command = app.add_subcommand("optimize", "Optimise a 2D or 3D pose graph (g2o), print its chi^2");
  command->add_option("GRAPH", arguments->graph, "g2o file (VERTEX_SE2 or VERTEX_SE3:QUAT)")->required();
  command->add_option("-o,--output", arguments->output, "g2o file to write")->required();
  command->add_option("--max-iterations", arguments->max_iterations, "stop after so many")
      ->check(aboveZero())
      ->capture_default_str();
  command->add_flag("--keep-start", arguments->keep_start,
                    "start from the file's poses even where the chordal start is better");
  command->add_flag("--quiet", arguments->quiet, "no progress");
  command->footer(
      "Examples:\n"
      "  roomgraph optimize manhattan3500.g2o -o optimum.g2o\n"
      "  roomgraph optimize out/lab/graph.g2o -o again.g2o --keep-start\n"
      "chi^2 is the sum of e' Omega e over all edges, e in g2o's convention, without robust losses.");
  command->callback([arguments] { optimizeFile(*arguments); });
}

}  // namespace roomgraph
