/// \file From a subject to the scene that the renderer draws. Builds with pictures only.
#pragma once
#include "batten/render/render.h"
#include "cli/picture.h"

namespace batten::cli {

/// Throws what the operators throw, and Error(BadArgument) for a colouring that the subject cannot have.
Scene scene_of(const Subject& subject, const PictureArguments& arguments, bool quiet);

/// The scale that the numbers over the subject's surface ask for; none where it has no numbers.
std::optional<ScaleRequest> surface_scale(const Subject& subject, Coloring coloring);

/// The mesh of the left panel, as it is.
Scene scene_before(const Subject& subject);

}  // namespace batten::cli
