// SPDX-License-Identifier: BSD-3-Clause
// Results of runs that never took place.
#pragma once

#include "roomgraph/catalogue/run_result.h"

namespace roomgraph::test {

/// A complete run with every field filled in.
inline RunResult madeUpResult(const std::string& input, int seed, const std::string& variant) {
  RunResult r;
  r.input = {input + "_s" + std::to_string(seed), input, seed, "/data/" + input + ".rawlog",
             std::string(64, 'a') + input,        1000};
  r.variant = variant;
  r.name = r.input.name + "--" + variant;
  r.status = "complete";
  r.key = "key of " + r.name;
  r.evaluation_key = "truth";
  r.version = "1.2";
  r.revision = "abcdef";
  r.program = "feed";
  r.parameters = {{"lidar.enabled", variant == "no_lidar" ? "false" : "true"},
                  {"pipeline.lookahead_s", "0.5"}};
  r.command = {"roomgraph", "run", "a b.rawlog"};
  r.started = "2026-01-02T03:04:05Z";
  r.wall_s = 10 + seed;
  r.cpu_s = 9.5;
  r.peak_memory_mb = 200 + seed;
  r.figures = {{"trajectory.ate_rmse_m", 0.01 * seed}, {"objects.f1", 0.5}};
  r.timings = {{"association", {41, 4.25, 0.5}}};
  r.failures = {{"2026-01-02T03:00:00Z", 137, "killed", 3.5}};
  r.files = {{"map.rgmap", 33304}};
  r.keep = "all";
  return r;
}

}  // namespace roomgraph::test
