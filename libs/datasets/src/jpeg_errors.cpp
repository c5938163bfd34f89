// SPDX-License-Identifier: BSD-3-Clause
// Replacement of libjpeg's fatal error handler by one that throws while a record is parsed.
#include <dlfcn.h>

#include <cstddef>
#include <cstdio>
// Needs the two above.
#include <jpeglib.h>

#include <stdexcept>
#include <string>

#include "roomgraph/core/allocation_limit.h"

// MRPT decodes the JPEG images of a record with libjpeg's standard handler of errors, which prints a line and
// calls exit(): one damaged image would end the program. This function takes the place of libjpeg's (as this
// library comes before it in the order in which symbols are looked up) and gives a handler that throws. Only
// for threads with an AllocationLimit, which are those that parse a record.

namespace {

[[noreturn]] void throwError(j_common_ptr info) {
  char text[JMSG_LENGTH_MAX];
  info->err->format_message(info, text);
  // As jpeg_destroy() does: MRPT will not get there.
  if (info->mem) info->mem->self_destruct(info);
  info->mem = nullptr;
  throw std::runtime_error(std::string("damaged JPEG image: ") + text);
}

void stayQuiet(j_common_ptr) {}

}  // namespace

extern "C" jpeg_error_mgr* jpeg_std_error(jpeg_error_mgr* errors) {
  using Function = jpeg_error_mgr* (*)(jpeg_error_mgr*);
  static const auto original = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "jpeg_std_error"));
  original(errors);
  if (roomgraph::AllocationLimit::active()) {
    errors->error_exit = throwError;
    errors->output_message = stayQuiet;
  }
  return errors;
}
