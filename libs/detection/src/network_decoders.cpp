// SPDX-License-Identifier: BSD-3-Clause
// Collection of decoders from the class registry, and choice of one of them.
#include "network_decoders.h"

#include <map>

#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(NetworkDecoder, mrpt::rtti::CObject, roomgraph)

std::vector<NetworkDecoderPtr> networkDecoders() {
  std::map<std::string, NetworkDecoderPtr> by_format;
  for (const auto& class_name : implementationsOf(CLASS_ID(NetworkDecoder))) {
    const NetworkDecoderPtr decoder = createStage<NetworkDecoder>(class_name, "network decoders");
    const auto [known, added] = by_format.emplace(decoder->name(), decoder);
    if (!added)
      throw ConfigError("two network decoders have the format name '" + decoder->name() +
                        "': " + known->second->GetRuntimeClass()->className + " and " +
                        decoder->GetRuntimeClass()->className);
  }
  std::vector<NetworkDecoderPtr> decoders;
  for (const auto& [format, decoder] : by_format) decoders.push_back(decoder);
  return decoders;
}

NetworkDecoderPtr decoderNamed(const std::string& format) {
  for (const auto& decoder : networkDecoders())
    if (decoder->name() == format) return decoder;
  return nullptr;
}

NetworkDecoderPtr decoderFor(const NetworkOutputs& outputs, int classes) {
  NetworkDecoderPtr found;
  for (const auto& decoder : networkDecoders()) {
    if (!decoder->recognises(outputs, classes)) continue;
    if (found)
      throw ConfigError(outputs.file.string() + ": the network's output fits the formats " + found->name() +
                        " and " + decoder->name() + "; say which: " + outputs.file.filename().string() + ":" +
                        found->name());
    found = decoder;
  }
  return found;
}

std::string knownFormats() {
  std::vector<std::string> names{"auto"};
  for (const auto& decoder : networkDecoders()) names.push_back(decoder->name());
  return join(names);
}

}  // namespace roomgraph
