// SPDX-License-Identifier: BSD-3-Clause
// What is told about an exception that no part of the program has an answer to.
#pragma once

#include <exception>
#include <string>

namespace roomgraph {

/// "not enough memory" for std::bad_alloc and OpenCV's error of that kind, "no thread can be started: …"
/// where the system refuses one, both with what helps; else "internal error: " and the text of the exception.
/// One line or more.
std::string textOfUnexpected(const std::exception& error);

}  // namespace roomgraph
