/// \file Pictures side by side, such as before and after, or a picture and its colour bar.
#pragma once
#include <string>
#include <vector>

#include "batten/render/picture.h"

namespace batten {

/// One picture of a row.
struct Panel {
  Picture picture;
  std::string caption;  ///< empty for none
};

/// Puts the panels from left to right on one background, centred in height. Throws Error(BadShape) for pictures without
/// pixels, Error(BadArgument) if there is no panel.
Picture beside(const std::vector<Panel>& panels, const PictureStyle& style = {});

/// The height that captions below pictures take: 0 unless the style has a text size.
int caption_height(const PictureStyle& style);

/// Puts so many panels into each row, the last row centred; caption_height is added to a row with captions. A caption
/// wider than its picture is made smaller. Throws what `beside` throws, and Error(BadArgument) for less than one
/// column.
Picture in_rows(const std::vector<Panel>& panels, int columns, const PictureStyle& style = {});

}  // namespace batten
