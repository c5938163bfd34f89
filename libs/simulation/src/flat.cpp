// SPDX-License-Identifier: BSD-3-Clause
// Random flats: drawn until one can be driven through and holds what it should.
#include "roomgraph/simulation/flat.h"

#include <algorithm>
#include <map>

#include "flat_draft.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/simulation/world_file.h"

namespace roomgraph {
namespace {

enum FlatStream : std::uint64_t { kFlatStream = 300, kRoomsStream };

/// Catalogue models in place of some built shapes; the built one's size stays.
void useMeshes(FlatDraft& draft, Random& random) {
  static const std::map<std::string, std::vector<std::string>> files{
      {"swivel_chair", {"katorlegaz/office-chair/office-chair.obj"}},
      {"wooden_chair", {"blendswap-cc-by/chair3/chair3.obj"}},
      {"sofa", {"blendswap-cc-0/sofa2/sofa2.obj", "scopia/burlap_sofa/burlap_sofa.obj", "blendswap-cc-by/sofa3/sofa3.obj"}}};
  for (auto& item : draft.world.furniture) {
    const auto known = files.find(item.model);
    if (known == files.end() || !random.chance(0.5)) continue;
    const auto file = std::filesystem::absolute(draft.options.meshes / pick(random, known->second));
    if (std::filesystem::is_regular_file(file)) item.mesh_file = file.string();
  }
}

/// One try; false: it cannot be driven through, or holds too little or too much.
bool drawFlat(FlatDraft& draft, int rooms, Random random) {
  planFlat(draft, rooms, random);
  decorateFlat(draft, random);
  furnishFlat(draft, random);
  const int counted = objectsThatCount(draft.world);
  if (counted < 8 || counted > 30 || objectsThatMislead(draft.world) < counted) return false;
  const int people = drawInt(random, 0, 6), sitting = drawInt(random, 0, std::min(2, people));
  const int standing = drawInt(random, 0, std::min(2, people - sitting));
  seatPeople(draft, sitting, standing, random);
  if (!planWay(draft, random)) return false;
  addWalkers(draft, people - sitting - standing, random);
  drawSensors(draft, random);
  if (!draft.options.meshes.empty()) useMeshes(draft, random);
  return isSound(draft.world);
}

}  // namespace

std::string flatText(const FlatOptions& options) {
  if (options.rooms < 0 || options.rooms > 5)
    throw ConfigError("a flat has 1 to 5 rooms (0: drawn), not " + std::to_string(options.rooms));
  constexpr std::uint64_t kAttempts = 500;
  // Before the first try, so that flats of many rooms are not rarer for being harder to draw.
  Random first(options.seed, kRoomsStream);
  const int rooms = options.rooms > 0 ? options.rooms : drawInt(first, 1, 5);
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    FlatDraft draft;
    draft.options = options;
    draft.world.name = "flat_" + std::to_string(options.seed);
    draft.world.file = draft.world.name;
    if (!drawFlat(draft, rooms, Random(options.seed, kFlatStream, attempt))) continue;
    return worldText(draft.world, "Random flat " + std::to_string(options.seed) +
                                      "; its recording has the same number as seed unless another was given.");
  }
  throw RunError("no flat found for seed " + std::to_string(options.seed));
}

World randomFlat(const FlatOptions& options) {
  return parseWorld(flatText(options), "flat_" + std::to_string(options.seed));
}

}  // namespace roomgraph
