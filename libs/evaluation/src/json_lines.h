// SPDX-License-Identifier: BSD-3-Clause
// Iteration over a file of JSON lines with errors by file and line.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "roomgraph/geometry/box.h"

namespace roomgraph {

/// Calls `use` with each line's value; empty lines are skipped. Every error of a line or of `use` becomes an InputError
/// with file and line. Returns the number of lines, empty ones included.
int forEachJsonLine(const std::filesystem::path& file, const std::function<void(const nlohmann::json&)>& use);

/// [u_min, v_min, u_max, v_max], px.
Box2 boxFrom(const nlohmann::json& numbers);

}  // namespace roomgraph
