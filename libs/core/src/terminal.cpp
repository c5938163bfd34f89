// SPDX-License-Identifier: BSD-3-Clause
// What the kernel knows of a terminal's window.
#include "roomgraph/core/terminal.h"

#include <sys/ioctl.h>

namespace roomgraph {

std::size_t terminalWidth(int descriptor) {
  constexpr std::size_t kUsual = 80;
  winsize size{};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

}  // namespace roomgraph
