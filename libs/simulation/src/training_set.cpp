// SPDX-License-Identifier: BSD-3-Clause
// Rendering, labelling and writing of training views.
#include "roomgraph/simulation/training_set.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "color_renderer.h"
#include "json_numbers.h"
#include "models.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/observations/rgbd_channels.h"
#include "roomgraph/simulation/flat.h"
#include "sensors.h"
#include "training_world.h"

namespace roomgraph {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kFirstReserved = 1000, kLastReserved = 1019;
enum TrainingStream : std::uint64_t { kWorldStream = 900, kViewStream };

/// One labelled view.
struct TrainingView {
  std::vector<cv::Mat> channels;
  Json label;
  int boxes = 0;
};

Json boxesOf(const std::vector<ObjectView>& views, const Scene& scene, double scale,
             const Eigen::Vector3d& camera) {
  Json out = Json::array();
  for (const auto& view : views) {
    const auto& object = scene.objects()[static_cast<std::size_t>(view.object)];
    const auto px = [&](int value) { return roundedTo(value * scale, 100); };
    out.push_back({{"kind", object.class_name == "person" ? "person" : object.kind},
                   {"box", {px(view.box.x), px(view.box.y), px(view.box.br().x), px(view.box.br().y)}},
                   {"visible", roundedTo(view.visible, 1000)},
                   {"unoccluded", roundedTo(view.unoccluded, 1000)},
                   {"depth", roundedTo(view.median_depth_m, 1000)}});
    if (object.moving) continue;
    const SeenPlace place = seenPlace(object.world_from_object, object.size_wdh.z(), camera);
    out.back()["range"] = roundedTo(place.range_m, 1000);
    out.back()["front"] = roundedTo(place.front_rad, 1000);
  }
  return out;
}

/// Is anything in view of what is looked for, rather than only what misleads?
bool seesWanted(const std::vector<ObjectView>& views, const Scene& scene) {
  return std::ranges::any_of(views, [&](const ObjectView& view) {
    return scene.objects()[static_cast<std::size_t>(view.object)].class_name != "other" && view.visible > 0.2;
  });
}

/// One flat, seen again and again.
class FlatViews {
 public:
  FlatViews(std::uint64_t flat, const TrainingSetOptions& options);
  /// Nothing when the camera stands in something; mostly nothing when it sees nothing, or nothing of what is
  /// looked for.
  std::optional<TrainingView> view(int index);

 private:
  static World drawWorld(std::uint64_t flat, const TrainingSetOptions& options);

  static constexpr int kFine = 2;  ///< exact pictures have this multiple of the input's size
  std::uint64_t flat_;
  const TrainingSetOptions& options_;
  World world_;
  Scene scene_;
  CameraSpec fine_;
  PinholeCamera coarse_;
  ColorRenderer renderer_;
};

World FlatViews::drawWorld(std::uint64_t flat, const TrainingSetOptions& options) {
  World world = randomFlat({flat, 0, false, {}});
  Random random(flat, kWorldStream);
  varyWorld(world, options.meshes, random);
  world.camera = drawTrainingCamera({kFine * options.size.width, kFine * options.size.height}, random);
  return world;
}

FlatViews::FlatViews(std::uint64_t flat, const TrainingSetOptions& options)
    : flat_(flat),
      options_(options),
      world_(drawWorld(flat, options)),
      scene_(world_),
      fine_(*world_.camera),
      coarse_(fine_.model.scaled(1.0 / kFine)),
      renderer_(scene_, coarse_) {}

std::optional<TrainingView> FlatViews::view(int index) {
  constexpr double kNearest_m = 0.25;
  Random random(flat_, kViewStream, static_cast<std::uint64_t>(index));
  const double seconds = random.uniform(0, scene_.duration());
  const Pose3 world_from_camera = drawTrainingView(scene_, seconds, random);
  const auto parts = scene_.partPoses(seconds);
  const IdImage exact = rasterize(scene_, parts, world_from_camera, fine_.model);
  double nearest = 0;
  cv::minMaxLoc(exact.depth, &nearest, nullptr, nullptr, nullptr, exact.depth > 0);
  if (nearest < kNearest_m || (exact.views.empty() && random.chance(0.9))) return {};
  if (!seesWanted(exact.views, scene_) && random.chance(0.7)) return {};
  CameraSpec spec = fine_;
  spec.noise_gain *= random.uniform(0.7, 1.4);
  cv::Mat depth_mm =
      measureDepth(exact.depth, spec, Random(flat_, kViewStream + 1, static_cast<std::uint64_t>(index)));
  spoilDepth(depth_mm, exact.object, random);
  cv::Mat depth, coarse_depth;
  depth_mm.convertTo(depth, CV_32F, 0.001);
  cv::resize(exact.depth, coarse_depth, options_.size, 0, 0, cv::INTER_NEAREST);
  CameraSpec color_spec = spec;
  color_spec.model = coarse_;
  const cv::Mat plain = renderer_.render(parts, world_from_camera, nearest);
  const cv::Mat color =
      spoilColor(measureColor(plain, ambientLight(coarse_depth, coarse_) * world_.light, color_spec,
                              Random(flat_, kViewStream + 2, static_cast<std::uint64_t>(index))),
                 random);
  TrainingView out;
  out.channels = rgbdChannels(color, depth, fine_.model, options_.size);
  out.label = {{"flat", flat_},
               {"index", index},
               {"fx", roundedTo(coarse_.fx, 100)},
               {"height", roundedTo(world_from_camera.translation().z(), 1000)},
               {"boxes", boxesOf(exact.views, scene_, 1.0 / kFine, world_from_camera.translation())}};
  out.boxes = static_cast<int>(exact.views.size());
  return out;
}

void check(const TrainingSetOptions& options) {
  if (options.first_flat > options.last_flat || options.views < 1 || options.size.width < 32 ||
      options.size.height < 32)
    throw ConfigError("a training set needs at least one flat, one view of each and 32 x 32 px");
  if (options.first_flat <= kLastReserved && options.last_flat >= kFirstReserved)
    throw ConfigError("flats " + std::to_string(kFirstReserved) + " to " + std::to_string(kLastReserved) +
                      " are kept for reporting: nothing may be trained on them");
}

}  // namespace

MeshChoice readMeshChoice(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file.string() + ": cannot be read");
  std::vector<std::string> kinds = furnitureModels();
  kinds.insert(kinds.end(), {"door", "person", "sitting person"});
  MeshChoice out;
  try {
    const Json choice = Json::parse(stream);
    for (const auto& [kind, files] : choice.items()) {
      if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
        throw ConfigError(file.string() + ": unknown kind '" + kind + "': one of " + join(kinds));
      for (const auto& one : files) out[kind].push_back(folder / one.get<std::string>());
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string() + ": not {\"KIND\": [\"FILE\", ...], ...}: " + error.what());
  }
  for (const auto& [kind, files] : out)
    for (const auto& one : files)
      if (!std::filesystem::is_regular_file(one))
        throw ConfigError(file.string() + ": " + kind + ": " + one.string() +
                          " is not there (worlds/extract_meshes.sh)");
  return out;
}

TrainingSetResult writeTrainingSet(const TrainingSetOptions& options, const std::filesystem::path& folder) {
  check(options);
  std::filesystem::create_directories(folder);
  OutputFile pixels(folder / "views.u8"), labels(folder / "views.jsonl");
  TrainingSetResult result;
  for (std::uint64_t flat = options.first_flat; flat <= options.last_flat && !result.interrupted; ++flat) {
    FlatViews views(flat, options);
    for (int i = 0; i < options.views && !result.interrupted; ++i) {
      result.interrupted = options.interrupted && options.interrupted();
      const auto view = views.view(i);
      if (!view) continue;
      for (const cv::Mat& channel : view->channels)
        pixels.write(reinterpret_cast<const char*>(channel.data),
                     static_cast<std::streamsize>(channel.total()));
      labels << view->label.dump() << "\n";
      ++result.views;
      result.boxes += view->boxes;
    }
    pixels.check();
    labels.check();
    ++result.flats;
    if (options.progress)
      options.progress(result.flats, static_cast<double>(options.last_flat - options.first_flat + 1));
  }
  pixels.finish();
  labels.finish();
  const Json summary{
      {"views", result.views},
      {"channels", kRgbdChannels},
      {"height", options.size.height},
      {"width", options.size.width},
      {"flats", {options.first_flat, options.first_flat + static_cast<std::uint64_t>(result.flats) - 1}}};
  writeFileAtomically(folder / "set.json", summary.dump(2) + "\n");
  return result;
}

}  // namespace roomgraph
