// SPDX-License-Identifier: BSD-3-Clause
// Orderly end on SIGINT, SIGTERM and SIGHUP: the first signal only raises a flag.
#pragma once

namespace roomgraph {

/// From now on the first Ctrl-C, SIGTERM or SIGHUP (a closed terminal) only raises a flag, so that what was
/// done so far can be written; a second Ctrl-C or SIGTERM ends the program at once.
void catchInterrupts();
bool interrupted();
/// Whether it was Ctrl-C: somebody sits there and wants it to end, not only this program.
bool interruptedByHand();

}  // namespace roomgraph
