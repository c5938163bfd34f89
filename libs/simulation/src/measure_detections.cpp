// SPDX-License-Identifier: BSD-3-Clause
// Simulated object detector: box jitter, misses, wrong labels and false alarms.
#include <algorithm>
#include <map>

#include "sensors.h"

namespace roomgraph {
namespace {

/// Label of the COCO data set for a class, a cabinet's of ADE20K; empty: a detector has no name for it.
std::string labelOf(const SceneObject& object) {
  static const std::map<std::string, std::string> classes{
      {"swivel_chair", "chair"}, {"sofa", "couch"}, {"person", "person"},
      {"door", "door"},          {"bed", "bed"},    {"table", "dining table"},
      {"cabinet", "cabinet"},    {"refrigerator", "refrigerator"}};
  static const std::map<std::string, std::string> kinds{
      {"wooden chair", "chair"}, {"plant", "potted plant"}, {"monitor", "tv"}, {"desk", "dining table"}};
  if (const auto found = classes.find(object.class_name); found != classes.end()) return found->second;
  const auto found = kinds.find(object.kind);
  return found == kinds.end() ? "" : found->second;
}

std::string randomLabel(Random& random) {
  static const std::vector<std::string> labels{"chair", "couch", "person", "door", "potted plant", "tv"};
  return labels[static_cast<std::size_t>(random.uniform() * static_cast<double>(labels.size()))];
}

/// Score that grows with what is seen, between 0.35 and 0.98.
float scoreOf(double visible, Random& random) {
  return static_cast<float>(std::clamp(0.4 + 0.5 * visible + 0.08 * random.normal(), 0.35, 0.98));
}

void clip(CObservationDetections::Item& item, const PinholeCamera& camera) {
  const double width = camera.width, height = camera.height;
  item.u_min = std::clamp(item.u_min, 0.0, width - 2);
  item.v_min = std::clamp(item.v_min, 0.0, height - 2);
  item.u_max = std::clamp(item.u_max, item.u_min + 1, width);
  item.v_max = std::clamp(item.v_max, item.v_min + 1, height);
}

}  // namespace

CObservationDetections measureDetections(const std::vector<ObjectView>& views, const Scene& scene,
                                         const PinholeCamera& camera, const DetectionsSpec& spec,
                                         Random random) {
  CObservationDetections out;
  out.image_width = static_cast<std::uint32_t>(camera.width);
  out.image_height = static_cast<std::uint32_t>(camera.height);
  out.model = "simulator";
  for (const auto& view : views) {
    const std::string label = labelOf(scene.objects()[static_cast<std::size_t>(view.object)]);
    if (label.empty() || view.visible < spec.min_visible || view.box.height < spec.min_height_px) continue;
    if (!random.chance(spec.detect_probability)) continue;
    CObservationDetections::Item item;
    item.label = random.chance(spec.confusion) ? randomLabel(random) : label;
    item.score = scoreOf(view.visible, random);
    const auto edge = [&](int at, int size) {
      return static_cast<float>(at + spec.jitter * size * random.normal());
    };
    item.u_min = edge(view.box.x, view.box.width);
    item.u_max = edge(view.box.br().x, view.box.width);
    item.v_min = edge(view.box.y, view.box.height);
    item.v_max = edge(view.box.br().y, view.box.height);
    clip(item, camera);
    out.items.push_back(item);
  }
  // Poisson number of false alarms, by multiplying uniform numbers (Knuth).
  for (double product = random.uniform(); product > std::exp(-spec.false_positives);
       product *= random.uniform()) {
    CObservationDetections::Item item;
    item.label = randomLabel(random);
    item.score = static_cast<float>(random.uniform(0.3, 0.6));
    const double width = random.uniform(0.05, 0.3) * camera.width,
                 height = random.uniform(0.08, 0.5) * camera.height;
    item.u_min = static_cast<float>(random.uniform(0, camera.width - width));
    item.v_min = static_cast<float>(random.uniform(0, camera.height - height));
    item.u_max = item.u_min + static_cast<float>(width);
    item.v_max = item.v_min + static_cast<float>(height);
    out.items.push_back(item);
  }
  return out;
}

}  // namespace roomgraph
