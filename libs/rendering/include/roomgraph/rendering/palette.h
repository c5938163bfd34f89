// SPDX-License-Identifier: BSD-3-Clause
// Colours of the pictures, and of object classes.
#pragma once

#include <mrpt/img/TColor.h>

#include <string>
#include <vector>

#include "roomgraph/observations/object_database.h"

namespace roomgraph::palette {

using mrpt::img::TColor;

inline const TColor kUnknown{233, 236, 241};  ///< also the picture's background
inline const TColor kFree{255, 255, 255};
inline const TColor kOccupied{58, 70, 87};
inline const TColor kGridLine{214, 220, 229};
inline const TColor kInk{38, 46, 58};          ///< text
inline const TColor kFaintInk{112, 122, 136};  ///< secondary text
inline const TColor kPathStart{200, 182, 240};
inline const TColor kPathEnd{92, 45, 160};

/// Linear mix, ratio 0 gives a, 1 gives b.
TColor mix(const TColor& a, const TColor& b, double ratio);
TColor withAlpha(TColor color, int alpha);
/// "#rrggbb"; grey when it has another form.
TColor parse(const std::string& text);
/// Colour of a class in the object database; grey when it is not there.
TColor ofClass(const ObjectDatabase& database, const std::string& class_name);

/// Seven colours that people with any of the three dichromacies tell apart, from one another, from walls and
/// from the path: M. Okabe and K. Ito, "Color universal design", 2008 (jfly.uni-koeln.de/color), without
/// their black.
const std::vector<TColor>& colorBlindSafe();
/// The same classes in these colours, in the order of the database; from the eighth class on darker, then
/// lighter ones, which differ by their labels and hatching only.
ObjectDatabase withSafeColors(const ObjectDatabase& database);

}  // namespace roomgraph::palette
