// SPDX-License-Identifier: BSD-3-Clause
// Exceptions of a machine that is too small, thrown by those who throw them.
#include "roomgraph/core/unexpected.h"

#include <gmock/gmock.h>

#include <csignal>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "memory_limit.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Unexpected, WantOfMemoryIsNoFaultOfTheProgram) {
  if (test::kMemoryCanBeLimited) {  // else the sanitizer ends the program at such a size
    try {
      volatile std::size_t all = std::numeric_limits<std::size_t>::max() / 4;
      ::operator delete(::operator new(all));  // a pair of new and delete expressions may be left out
      FAIL() << "so much memory has nobody";
    } catch (const std::exception& error) {
      EXPECT_THAT(textOfUnexpected(error), StartsWith("not enough memory: "));
    }
  }
  const std::runtime_error open_cv(
      "OpenCV(4.6.0) ./modules/core/src/alloc.cpp:73: error: (-4:Insufficient memory) Failed to allocate "
      "495696 bytes");
  EXPECT_THAT(textOfUnexpected(open_cv), StartsWith("not enough memory: "));
  EXPECT_THAT(textOfUnexpected(std::runtime_error("Message:  std::bad_alloc")),
              StartsWith("not enough memory: "));
}

TEST(Unexpected, WantOfThreadsNeither) {
  const std::system_error system(std::make_error_code(std::errc::resource_unavailable_try_again));
  EXPECT_THAT(textOfUnexpected(system),
              AllOf(StartsWith("no thread can be started: "), HasSubstr("temporarily")));
  EXPECT_THAT(
      textOfUnexpected(std::runtime_error("pthread_create has failed: Resource temporarily unavailable")),
      StartsWith("no thread can be started: "));
}

TEST(Unexpected, AllElseIsAnInternalError) {
  EXPECT_EQ(textOfUnexpected(std::out_of_range("map::at")), "internal error: map::at");
  const std::system_error other(std::make_error_code(std::errc::permission_denied));
  EXPECT_THAT(textOfUnexpected(other), StartsWith("internal error: "));
}

// Threads of libraries, which nobody can catch anything of.
TEST(UnexpectedDeathTest, WantOfMemoryInAThreadIsTold) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto throwInThread = [](const auto& error) {
    tellOfShortagesInThreads("program");
    std::thread([&] { throw error; }).join();
  };
  EXPECT_EXIT(throwInThread(std::bad_alloc()), ::testing::ExitedWithCode(1), "^program: not enough memory: [^\n]*\n$");
  EXPECT_EXIT(throwInThread(std::runtime_error("broken")), ::testing::KilledBySignal(SIGABRT), "broken");
}

}  // namespace
}  // namespace roomgraph
