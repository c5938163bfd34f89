// SPDX-License-Identifier: BSD-3-Clause
// Bytes as text, for pictures inside JSON and pages (RFC 4648).
#pragma once

#include <string>
#include <string_view>

namespace roomgraph {

/// With padding.
std::string toBase64(std::string_view bytes);
/// The bytes of such a text, padding included. Throws std::invalid_argument saying what is wrong with it.
std::string fromBase64(std::string_view text);

}  // namespace roomgraph
