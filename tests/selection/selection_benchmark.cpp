// SPDX-License-Identifier: BSD-3-Clause
// Time of one frame's selection, and what each selector chooses in scenes with known truth, by Google
// Benchmark; not a test. Choices are counters: `selection_benchmark --benchmark_filter=Scene
// --benchmark_counters_tabular=true`.
#include <benchmark/benchmark.h>

#include <array>

#include "best_score_selector.h"
#include "crf_selector.h"
#include "made_up_room.h"
#include "selection_scenes.h"
#include "unary_selector.h"

namespace roomgraph::test {
namespace {

// 8 boxes, 4 proposals each, 8 * 12 + 900 features; the camera swings and every third frame misses an object.
template <class Selector>
void selectEightObjects(benchmark::State& state) {
  std::vector<RoomObject> objects;
  for (int k = 0; k < 8; ++k)
    objects.push_back(k % 2 ? chairAt(3 + k % 3, 0.4 * (k - 4)) : sofaAt(3 + k % 3, 0.4 * (k - 4), 1));
  Random random(1);
  std::vector<std::pair<FrameProposals, FrameContext>> frames;
  for (int f = 0; f < 30; ++f) {
    FrameContext context = viewFrom(0, 0, 0.01 * std::abs(f - 15));
    auto seen = objects;
    if (f % 3 == 0) seen.back().world_from_object.translation().x() = -5;
    FrameProposals frame = seenFrom(context, seen, 4, 0.2, random);
    for (int i = 0; i < 900; ++i)
      context.features.push_back({{random.uniform(0, 640), random.uniform(0, 480)}, 10000 + i, 3});
    frames.emplace_back(std::move(frame), std::move(context));
  }
  Selector selector;
  std::size_t next = 0;
  for (auto _ : state) {
    const auto& [frame, context] = frames[next++ % frames.size()];
    benchmark::DoNotOptimize(selector.select(frame, context));
  }
}

BENCHMARK(selectEightObjects<BestScoreSelector>)->Unit(benchmark::kMicrosecond);
BENCHMARK(selectEightObjects<UnarySelector>)->Unit(benchmark::kMicrosecond);
BENCHMARK(selectEightObjects<CrfSelector>)->Unit(benchmark::kMicrosecond);

// Right and wrong choices over 200 scenes, and how good the confidences are.
void scene(benchmark::State& state, Scene (*made)(unsigned), const std::string& selector,
           const std::string& keys) {
  SceneCounts counts;
  for (auto _ : state) counts = countOver(made, selector, keys, 1001, 200);
  state.counters["right"] = counts.rightShare();
  state.counters["identity"] = counts.identityShare();
  state.counters["false"] = counts.falseShare();
  state.counters["brier"] = counts.brierScore();
}

void registerScenes() {
  const std::pair<const char*, Scene (*)(unsigned)> scenes[] = {{"occluder_enters", occluderEnters},
                                                                {"occluder_leaves", occluderLeaves},
                                                                {"box_flickers", boxFlickers},
                                                                {"two_depths", twoDepthsCompete},
                                                                {"change_order", chairsChangeOrder},
                                                                {"chair_moved", chairIsMoved},
                                                                {"jerky_row", jerkyRow},
                                                                {"weak_object", weakObject}};
  const std::array<const char*, 3> arms[] = {
      {"unary", "UnarySelector", ""},
      {"paper", "CrfSelector", "link_weight = 0"},
      {"whole", "CrfSelector", "link_weight = 1"},
      {"crf", "CrfSelector", ""},
      {"no_order", "CrfSelector", "order_bonus = 0"},
      {"none_competes", "CrfSelector", "none_competes = true"},
      {"never_binds", "CrfSelector", "none_competes = true\nwindow_frames = 100"},
      {"loose", "UnarySelector", "max_energy = -0.1"}};
  for (const auto& [name, made] : scenes)
    for (const auto& [arm, selector, keys] : arms)
      benchmark::RegisterBenchmark((std::string("Scene/") + name + "/" + arm).c_str(), scene, made, selector,
                                   keys)
          ->Iterations(1)
          ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace roomgraph::test

int main(int argc, char** argv) {
  roomgraph::test::registerScenes();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
