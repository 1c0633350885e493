/// \file The two formats of medial models: 3D Slicer's elliptical s-reps, and figures of atoms.
#pragma once
#include <string>
#include <string_view>

#include "batten/io/json_place.h"
#include "batten/medial/medial_model.h"

namespace batten::medial {

using io::Json;
using io::JsonPlace;

/// "line 3, step 1, UpSpoke, Direction", from the steps that lead from the root. Empty at the root.
std::string place_text(const std::vector<io::JsonStep>& steps);

/// A whole file of either format; `name` is what errors call it. Throws what read_medial() does.
MedialModel model_from_text(const std::string& name, std::string_view text);

/// document: the whole file. Throws Error(BadFile) naming line and step.
MedialModel srep_from_json(const JsonPlace& document);
/// figure: on an elliptical grid. In LPS.
Json srep_to_json(const MedialFigure& figure);

/// Batten's own format.
MedialModel figures_from_json(const JsonPlace& document);
Json figures_to_json(const MedialModel& model);

}  // namespace batten::medial
