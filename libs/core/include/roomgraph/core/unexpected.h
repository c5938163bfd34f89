// SPDX-License-Identifier: BSD-3-Clause
// What is told about an exception that no part of the program has an answer to.
#pragma once

#include <cstddef>
#include <exception>
#include <string>

namespace roomgraph {

/// "not enough memory" for std::bad_alloc and OpenCV's error of that kind, "no thread can be started: …"
/// where the system refuses one, both with what helps; else "internal error: " and the text of the exception.
/// One line or more.
std::string textOfUnexpected(const std::exception& error);

/// From now on a std::bad_alloc that nobody catches, as of a thread of a library that gets no memory, ends the process with exit code 1 and
/// one line that begins with `who`. Any other exception ends it as ever, by std::abort.
void tellOfShortagesInThreads(const char* who);

/// How often the system has refused memory to this process, through operator new or mrpt::aligned_malloc.
/// What an AllocationLimit refuses does not count.
std::size_t memoryShortages();

/// For those who take an exception for damaged input: throws RunError when it was the machine that had no
/// memory, as since there were `before` shortages it refused some, or as OpenCV says so.
void throwIfShort(const std::exception& error, std::size_t before);

}  // namespace roomgraph
