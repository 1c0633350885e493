/// \file Numbers as colours with a bar, by the tables of the tool's pictures.
#pragma once
#include <string>

#include "batten/render/color_scale.h"
#include "studio/engine/arrays.h"

namespace batten::studio {

/// {numbers, positions, scale: {title, unit, low, high, lowest, highest, colors (sRGB bytes), ticks: [{place, text}]}}.
val colored(const Scalars& numbers, const ScaleRequest& request);

}  // namespace batten::studio
