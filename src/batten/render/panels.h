/// \file Pictures side by side: before and after, a picture and its colour bar.
#pragma once
#include <string>
#include <vector>

#include "batten/render/picture.h"

namespace batten {

/// One picture of a row.
struct Panel {
  Picture picture;
  std::string caption;  ///< at the foot of the picture, over what it shows there; empty for none
};

/// From left to right, centred in height on one background.
/// Throws Error(BadShape) for pictures without pixels, Error(BadArgument) for no panel.
Picture beside(const std::vector<Panel>& panels, const PictureStyle& style = {});

}  // namespace batten
