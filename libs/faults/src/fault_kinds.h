// SPDX-License-Identifier: BSD-3-Clause
// Faults made of what a user asks for.
#pragma once

#include <memory>

#include "fault.h"
#include "roomgraph/core/random.h"
#include "roomgraph/faults/damage.h"

namespace roomgraph {

/// Throws ConfigError: unknown kind, bad value.
std::unique_ptr<Fault> makeFault(const FaultRequest& request, const Random& random);

}  // namespace roomgraph
