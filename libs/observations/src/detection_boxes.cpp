// SPDX-License-Identifier: BSD-3-Clause
// Detections out of records and comments; labels into classes.
#include "detection_boxes.h"

#include <algorithm>
#include <set>

#include "last_result.h"
#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {

std::shared_ptr<const CObservationDetections> detectionsIn(const mrpt::obs::CObservation& observation) {
  if (const auto* detections = dynamic_cast<const CObservationDetections*>(&observation))
    return {std::shared_ptr<void>(), detections};  // not owned: the caller holds the observation
  const auto* comment = dynamic_cast<const mrpt::obs::CObservationComment*>(&observation);
  if (!comment || !holdsDetections(*comment)) return nullptr;
  thread_local LastResult<std::shared_ptr<const CObservationDetections>> last;
  return last.of(comment->text, [&](const std::string&) -> std::shared_ptr<const CObservationDetections> {
    const auto read = fromComment(*comment);
    return read ? *read : nullptr;
  });
}

std::shared_ptr<const ObjectDatabase> databaseOf(const CSemanticMap& map) {
  if (map.provenance.objects.empty()) return nullptr;
  thread_local LastResult<std::shared_ptr<const ObjectDatabase>> last;
  return last.of(map.provenance.objects, [](const std::string& text) {
    return std::make_shared<const ObjectDatabase>(ObjectDatabase::fromText(text, "objects of the map"));
  });
}

std::vector<ClassBox> boxesOfLandmarks(const CObservationDetections& detections,
                                          const ObjectDatabase* database) {
  std::vector<ClassBox> out;
  for (const auto& item : detections.items) {
    const Box2 box{item.u_min, item.v_min, item.u_max, item.v_max};
    const ObjectModel* model = database ? database->byLabel(item.label) : nullptr;
    if (box.empty() || (database && (!model || !model->landmark))) continue;
    out.push_back({box, model ? model->class_name : item.label});
  }
  return out;
}

int labelCount(const CSemanticMap& map, const ObjectDatabase* database) {
  std::set<std::string> names;
  if (database) {
    for (const ObjectModel& model : database->models())
      if (model.landmark) names.insert(model.class_name);
  } else {
    for (const Landmark& landmark : map.landmarks)
      for (const auto& [name, probability] : landmark.class_posterior) names.insert(name);
  }
  return std::max<int>(1, static_cast<int>(names.size()));
}

}  // namespace roomgraph
