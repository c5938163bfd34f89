// SPDX-License-Identifier: BSD-3-Clause
// Greedy assignment within a gate, registered when the plug-in is loaded.
#include "greedy_nearest_associator.h"

#include <mrpt/core/initializer.h>

#include <algorithm>
#include <tuple>

#include "roomgraph/core/plugin.h"

ROOMGRAPH_PLUGIN()

namespace example {

IMPLEMENTS_MRPT_OBJECT(GreedyNearestAssociator, roomgraph::Associator, example)

void GreedyNearestAssociator::declareParameters(roomgraph::ParameterVisitor& v) {
  v.add("gate_m", gate_m_, {.doc = "Largest distance to a landmark.", .unit = "m", .min = 0, .max = 10});
}

std::vector<roomgraph::Association> GreedyNearestAssociator::associate(
    const std::vector<roomgraph::WorldMeasurement>& measurements,
    const std::vector<roomgraph::Landmark>& landmarks) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // distance, measurement, landmark
  for (std::size_t i = 0; i < measurements.size(); ++i)
    for (std::size_t j = 0; j < landmarks.size(); ++j) {
      if (measurements[i].measurement.proposal.class_name != landmarks[j].class_name) continue;
      const Eigen::Vector3d gap = measurements[i].world_from_object.translation() - landmarks[j].position;
      if (gap.head<2>().norm() <= gate_m_) pairs.emplace_back(gap.head<2>().norm(), i, j);
    }
  std::sort(pairs.begin(), pairs.end());

  std::vector<roomgraph::Association> out(measurements.size());
  std::vector<char> taken(landmarks.size(), 0);
  for (const auto& [distance, i, j] : pairs) {
    if (out[i].landmark.valid() || taken[j]) continue;
    out[i].landmark = landmarks[j].id;
    taken[j] = 1;
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].measurement = i;
    out[i].posterior = {{out[i].landmark, 1.0}};
  }
  return out;
}

}  // namespace example

// Runs when the library is loaded, before the configuration asks for the class.
MRPT_INITIALIZER(registerExampleAssociator) {
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(GreedyNearestAssociator, example));
}
