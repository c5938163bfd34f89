// SPDX-License-Identifier: BSD-3-Clause
// fork(), limits, and the reading of an exit status.
#include "trial_process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <opencv2/core/utility.hpp>

namespace roomgraph {
namespace {

constexpr int kSurvived = 0;

// Sanitizers take terabytes of addresses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

std::size_t addressSpaceNow() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void limitProcess(const TrialLimits& limits) {
  const rlimit none{0, 0},
      cpu{limits.cpu_s, limits.cpu_s + 1};  // at the second one the signal would be SIGKILL
  setrlimit(RLIMIT_CORE, &none);
  setrlimit(RLIMIT_CPU, &cpu);
  if (kSanitized) return;
  const rlim_t bytes = addressSpaceNow() + limits.memory_bytes;
  const rlimit memory{bytes, bytes};
  setrlimit(RLIMIT_AS, &memory);
}

// OpenCV's threads are not in a forked process: whoever asks them for something there waits forever, and so does whoever
// tells OpenCV there to do without.
class WithoutThreads {
 public:
  WithoutThreads() { cv::setNumThreads(1); }
  ~WithoutThreads() { cv::setNumThreads(before_); }
  WithoutThreads(const WithoutThreads&) = delete;
  WithoutThreads& operator=(const WithoutThreads&) = delete;

 private:
  int before_ = cv::getNumThreads();
};

[[noreturn]] void tryOut(const std::function<void()>& work, const TrialLimits& limits) {
  // Handlers of the program, or of a sanitizer, would report a crash as its own.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGALRM}) std::signal(signal, SIG_DFL);
  alarm(limits.wall_s);
  // What the library says of the file it says again in this process.
  if (const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  limitProcess(limits);
  try {
    work();
  } catch (const std::exception&) {
    // Comes again where the work is done in earnest.
  }
  _exit(kSurvived);
}

}  // namespace

std::string fateOfTrial(const std::function<void()>& work, const TrialLimits& limits) {
  const WithoutThreads without_threads;
  const pid_t child = fork();
  if (child < 0) return "";
  if (child == 0) tryOut(work, limits);
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return "";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return "needed more than " + std::to_string(limits.cpu_s) + " s of processor time";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    return "did not come to an end within " + std::to_string(limits.wall_s) + " s";
  if (WIFSIGNALED(status))
    return "ended by signal " + std::to_string(WTERMSIG(status)) + " (" + strsignal(WTERMSIG(status)) + ")";
  return WEXITSTATUS(status) == kSurvived ? ""
                                          : "ended with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace roomgraph
