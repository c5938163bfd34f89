// SPDX-License-Identifier: BSD-3-Clause
// Parameters common to the selectors that decide by energy.
#pragma once

#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// Bound of the unary energy, and temperature of the confidences, of CrfSelector and UnarySelector.
struct EnergyOptions {
  double max_energy = -0.15;
  double temperature = 0.1;

  void declare(ParameterVisitor& v) {
    v.add("max_energy", max_energy,
          {.doc = "A proposal is selected when its unary energy alpha * U (Eq. 4) is at most this.",
           .min = -1,
           .max = 0});
    v.add("temperature", temperature,
          {.doc = "Temperature of the Boltzmann distribution that turns energies into confidences.",
           .min = 0.001,
           .max = 10});
  }
};

}  // namespace roomgraph
