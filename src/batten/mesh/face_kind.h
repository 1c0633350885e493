/// \file What meshes that are made here consist of.
#pragma once

namespace batten {

/// The faces of a mesh that an operation makes.
enum class FaceKind { Quads, Triangles };

}  // namespace batten
