// SPDX-License-Identifier: BSD-3-Clause
// Exceptions of the standard library, TBB and OpenCV that mean a machine too small, in words.
#include "roomgraph/core/unexpected.h"

#include <cstring>
#include <system_error>

namespace roomgraph {
namespace {

// OpenCV throws an exception of its own; its number for this is -4. TBB throws a std::runtime_error.
constexpr const char* kOpenCvMemory = "(-4:Insufficient memory)";
constexpr const char* kNotEnough =
    "not enough memory: the machine, or a limit (ulimit -v, a container, a queue), gives no more";
constexpr const char* kTbbThread = "pthread_create has failed";

bool isWantOfThreads(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return (system && system->code() == std::errc::resource_unavailable_try_again) ||
         std::strstr(error.what(), kTbbThread);
}

}  // namespace

std::string textOfUnexpected(const std::exception& error) {
  // Others pass it on as a text of their own.
  if (std::strstr(error.what(), "std::bad_alloc") || std::strstr(error.what(), kOpenCvMemory))
    return kNotEnough;
  if (isWantOfThreads(error))
    return std::string(
               "no thread can be started: not enough memory, or a limit on processes (ulimit -v, -u); fewer: "
               "--threads 1 (") +
           error.what() + ")";
  return std::string("internal error: ") + error.what();
}

}  // namespace roomgraph
