// SPDX-License-Identifier: BSD-3-Clause
// Bytes as text for pictures inside a page (RFC 4648).
#pragma once

#include <string>
#include <string_view>

namespace roomgraph {

std::string toBase64(std::string_view bytes);

}  // namespace roomgraph
