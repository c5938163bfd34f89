// SPDX-License-Identifier: BSD-3-Clause
// The places at which a file of a network is looked for.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/models/catalogue.h"

namespace roomgraph {

bool isAddress(const std::string& from);

/// Where to look for the file, in this order: below `from`, an existing folder or an address, directly and in
/// sub-folders of the network's; its published address when `from` is empty. Throws ConfigError (no such
/// scheme, nothing published), InputError (no such folder).
std::vector<std::string> placesOf(const KnownNetwork& network, const KnownFile& file,
                                  const std::string& from);

}  // namespace roomgraph
