// SPDX-License-Identifier: BSD-3-Clause
// Plug-ins with one fault each, chosen when they are compiled.
#include <mrpt/core/initializer.h>

#include "roomgraph/core/plugin.h"
#include "roomgraph/core/stage.h"

#ifdef ODD_VERSION
extern "C" int roomgraphPluginInterfaceVersion() {
  return ODD_VERSION;
}
#else
ROOMGRAPH_PLUGIN()
#endif

// A class with the full name of that of the example plug-in.
#ifdef ODD_TWIN
#include "roomgraph/association/associator.h"

namespace example {

class GreedyNearestAssociator : public roomgraph::Associator {
  DEFINE_MRPT_OBJECT(GreedyNearestAssociator, example)
 public:
  std::vector<roomgraph::Association> associate(const std::vector<roomgraph::WorldMeasurement>&,
                                                const std::vector<roomgraph::Landmark>&) override {
    return {};
  }
};

IMPLEMENTS_MRPT_OBJECT(GreedyNearestAssociator, roomgraph::Associator, example)

}  // namespace example

MRPT_INITIALIZER(registerOddTwin) {
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(GreedyNearestAssociator, example));
}
#endif
