// SPDX-License-Identifier: BSD-3-Clause
// To be preloaded: whoever reads the file $ROOMGRAPH_FAILING_FILE from its beginning gets an error from byte
// $ROOMGRAPH_FAILING_FROM on, as on a broken disk.
#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

namespace {

bool isTheFile(int descriptor) {
  static const char* const file = std::getenv("ROOMGRAPH_FAILING_FILE");
  char name[PATH_MAX] = {};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  return file && readlink(link.c_str(), name, sizeof name - 1) > 0 && std::strcmp(name, file) == 0;
}

// Bytes read without a jump since the beginning of the file, by descriptor.
std::map<int, off_t>& sequential() {
  static std::map<int, off_t> bytes;
  return bytes;
}

}  // namespace

extern "C" ssize_t read(int descriptor, void* out, size_t count) {
  using Read = ssize_t (*)(int, void*, size_t);
  static const auto system_read = reinterpret_cast<Read>(dlsym(RTLD_NEXT, "read"));
  static const char* const from = std::getenv("ROOMGRAPH_FAILING_FROM");
  if (!from || !isTheFile(descriptor)) return system_read(descriptor, out, count);
  const off_t at = lseek(descriptor, 0, SEEK_CUR);
  off_t& before = sequential()[descriptor];
  if (at == 0) before = 0;
  if (before == at && at >= std::atoll(from)) {
    errno = EIO;
    return -1;
  }
  const ssize_t got = system_read(descriptor, out, count);
  if (got > 0) before += got;
  return got;
}
