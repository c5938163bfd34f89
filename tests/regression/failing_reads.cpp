// SPDX-License-Identifier: BSD-3-Clause
// To be preloaded: reading the file $ROOMGRAPH_FAILING_FILE fails from byte $ROOMGRAPH_FAILING_FROM on, as on
// a broken disk.
#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

bool isFailing(int descriptor) {
  static const char* const file = std::getenv("ROOMGRAPH_FAILING_FILE");
  static const char* const from = std::getenv("ROOMGRAPH_FAILING_FROM");
  if (!file || !from) return false;
  char name[PATH_MAX] = {};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  return readlink(link.c_str(), name, sizeof name - 1) > 0 && std::strcmp(name, file) == 0 &&
         lseek(descriptor, 0, SEEK_CUR) >= std::atoll(from);
}

}  // namespace

extern "C" ssize_t read(int descriptor, void* out, size_t count) {
  using Read = ssize_t (*)(int, void*, size_t);
  static const auto system_read = reinterpret_cast<Read>(dlsym(RTLD_NEXT, "read"));
  if (isFailing(descriptor)) {
    errno = EIO;
    return -1;
  }
  return system_read(descriptor, out, count);
}
