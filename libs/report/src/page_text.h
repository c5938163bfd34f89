// SPDX-License-Identifier: BSD-3-Clause
// Texts of the page (libs/report/page), embedded when the library is built.
#pragma once

#include <string_view>

namespace roomgraph {

extern const std::string_view kPageText, kPageStyles, kPageScripts;

}  // namespace roomgraph
