// SPDX-License-Identifier: BSD-3-Clause
// One-line messages from exceptions of MRPT and of JSON parsing.
#pragma once

#include <exception>
#include <string>

namespace roomgraph {

/// First line of an exception's text, without MRPT's call stack and nlohmann-json's "[json.exception…]".
std::string firstLine(const std::exception& error);

/// The same for an error in parsing a JSON text: what is wrong, and the line and column where. In a text of
/// one line only the column is named.
std::string jsonProblem(const std::exception& error, const std::string& text);

}  // namespace roomgraph
