/// \file A medial model as a mesh to look at.
#pragma once
#include "batten/medial/medial_model.h"

namespace batten {

/// The sheets and a thin prism for each spoke, with "color" at the vertices: the sheets grey, upward spokes blue,
/// downward ones orange, crest spokes red. thickness: of a prism, as a share of the diagonal of the bounding box of all
/// ends. For pictures: the mesh is no surface. Throws what require_medial throws. O(atoms).
Mesh spoke_mesh(const MedialModel& model, double thickness = 0.005);

}  // namespace batten
