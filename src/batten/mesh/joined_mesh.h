/// \file Several meshes as one.
#pragma once
#include <span>

#include "batten/mesh/mesh.h"

namespace batten {

/// The vertices and faces of one mesh after the other, with creases, corners and holes. What the meshes say of the
/// surface is taken from the first one; attributes and groups are left out.
Mesh joined_mesh(std::span<const Mesh> meshes);

}  // namespace batten
