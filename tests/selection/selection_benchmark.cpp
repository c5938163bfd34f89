// SPDX-License-Identifier: BSD-3-Clause
// Time of one frame's selection, with codes and window, measured by Google Benchmark; not a test.
#include <benchmark/benchmark.h>

#include "best_score_selector.h"
#include "crf_selector.h"
#include "made_up_room.h"
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

}  // namespace
}  // namespace roomgraph::test

BENCHMARK_MAIN();
