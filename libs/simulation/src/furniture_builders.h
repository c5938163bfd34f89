// SPDX-License-Identifier: BSD-3-Clause
// Builders of furniture meshes by kind.
#pragma once

#include "mesh_builder.h"

namespace roomgraph {

using Rgb = std::array<double, 3>;

/// What a builder gets: it builds about size (w, d, h), x to the front, bottom at z = 0; the caller fits it
/// exactly.
struct BuildRequest {
  MeshBuilder& mesh;
  double w, d, h;
  Rgb color;
  int variant;
  int shape;  ///< 0: the usual proportions; any other number: others
};

// Seats
void buildSwivelChair(const BuildRequest& request);
void buildSofa(const BuildRequest& request);
void buildWoodenChair(const BuildRequest& request);
void buildVisitorChair(const BuildRequest& request);
void buildStool(const BuildRequest& request);
void buildBench(const BuildRequest& request);
// Tables and cases
void buildDesk(const BuildRequest& request);
void buildShelf(const BuildRequest& request);
void buildCabinet(const BuildRequest& request);
void buildBlock(const BuildRequest& request);
// Bedroom and kitchen
void buildBed(const BuildRequest& request);
void buildTable(const BuildRequest& request);
void buildCupboard(const BuildRequest& request);
void buildRefrigerator(const BuildRequest& request);
void buildRoundTable(const BuildRequest& request);
// Smaller things
void buildPlant(const BuildRequest& request);
void buildMonitor(const BuildRequest& request);
void buildCardboardBox(const BuildRequest& request);
void buildBin(const BuildRequest& request);
void buildWhiteboard(const BuildRequest& request);
void buildPrinter(const BuildRequest& request);
void buildCoatStand(const BuildRequest& request);

/// Colour made lighter (gain > 1) or darker.
Rgb toned(const Rgb& color, double gain);

}  // namespace roomgraph
