/// \file The components of a contour that the points hold up.
#pragma once
#include "batten/fit/cloud_field.h"
#include "batten/fit/first_mesh.h"

namespace batten {

/// Some samples, as many as are asked for at most, evenly through the order.
Points some_samples(const CloudSamples& samples, Index most);

/// Drops components beside which fewer than a hundredth of the places lie, or four; returns how many.
Index drop_unsupported(Mesh& mesh, const Points& places);

/// The components of a mesh that Topology accepts.
std::vector<FirstMeshPart> mesh_parts(const Mesh& mesh);

/// Keeps the faces with a mark and creases between vertices that stay, drops vertices that no face has then.
void keep_faces(Mesh& mesh, const Buffer<std::uint8_t>& kept);

}  // namespace batten
