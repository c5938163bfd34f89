// SPDX-License-Identifier: BSD-3-Clause
// Exceptions of the standard library, TBB and OpenCV that mean a machine too small, in words.
#include "roomgraph/core/unexpected.h"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <new>
#include <system_error>

#include "roomgraph/core/errors.h"

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

namespace {

std::terminate_handler usual_end = nullptr;
const char* teller = "";

// Without memory of its own.
void endInWords() {
  try {
    if (const auto error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    for (const char* text : {teller, ": ", kNotEnough, "\n"})
      if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) break;  // nobody is there to be told
    _exit(1);
  } catch (...) {
    // Its text is told by the handler there was.
  }
  usual_end();
}

}  // namespace

void tellOfShortagesInThreads(const char* who) {
  teller = who;
  usual_end = std::set_terminate(endInWords);
}

void throwIfShort(const std::exception& error, std::size_t before) {
  if (memoryShortages() != before || std::strstr(error.what(), kOpenCvMemory)) throw RunError(kNotEnough);
}

}  // namespace roomgraph
