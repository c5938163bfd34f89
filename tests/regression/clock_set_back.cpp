// SPDX-License-Identifier: BSD-3-Clause
// To be preloaded: the clock of the day goes back by an hour with every tenth look at it. The monotonic clock
// stays as it is.
#include <dlfcn.h>
#include <sys/time.h>
#include <time.h>

#include <atomic>

namespace {

constexpr time_t kStep_s = 3600;
constexpr int kLooks = 10;

time_t setBack() {
  static std::atomic<int> looks = 0;
  return looks++ / kLooks * kStep_s;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* out) noexcept {
  using Get = int (*)(clockid_t, timespec*);
  static const auto system_get = reinterpret_cast<Get>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int code = system_get(clock, out);
  if (code == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) out->tv_sec -= setBack();
  return code;
}

extern "C" int gettimeofday(timeval* out, void* /*zone*/) noexcept {
  timespec now{};
  if (clock_gettime(CLOCK_REALTIME, &now) != 0) return -1;
  *out = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

extern "C" time_t time(time_t* out) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (out) *out = now.tv_sec;
  return now.tv_sec;
}
