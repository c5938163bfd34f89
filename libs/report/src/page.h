// SPDX-License-Identifier: BSD-3-Clause
// The page around its data: template with styles and scripts put in.
#pragma once

#include <string>

namespace roomgraph {

/// `json` as dataJson() makes it.
std::string pageAround(const std::string& json);

}  // namespace roomgraph
