// SPDX-License-Identifier: BSD-3-Clause
// The registered network decoders: by name, and by what a network gave.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "roomgraph/detection/network_decoder.h"

namespace roomgraph {

using NetworkDecoderPtr = std::shared_ptr<const NetworkDecoder>;

/// One of each registered class, those of plug-ins too, by format name. Throws ConfigError when two have the same
/// format name.
std::vector<NetworkDecoderPtr> networkDecoders();

/// The decoder of this format; null when there is none.
NetworkDecoderPtr decoderNamed(const std::string& format);

/// The decoder that recognises the outputs; null when none does. Throws ConfigError when several do.
NetworkDecoderPtr decoderFor(const NetworkOutputs& outputs, int classes);

/// "auto, ade20k, darknet, …": the formats allowed after a network's file name.
std::string knownFormats();

}  // namespace roomgraph
