/// \file Pictures side by side, such as before and after, or a picture and its colour bar.
#pragma once
#include <string>
#include <vector>

#include "batten/render/picture.h"

namespace batten {

/// One picture of a row.
struct Panel {
  Picture picture;
  std::string caption;  ///< drawn over the bottom of the picture; empty for none
};

/// Puts the panels from left to right on one background, centred in height. Throws Error(BadShape) for pictures without
/// pixels, Error(BadArgument) if there is no panel.
Picture beside(const std::vector<Panel>& panels, const PictureStyle& style = {});

}  // namespace batten
