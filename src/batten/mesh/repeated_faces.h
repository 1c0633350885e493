/// \file Faces that occur several times in a mesh.
#pragma once
#include <functional>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// Calls visit(first, later, same_direction) for faces with the same vertices; the lowest face comes first. `names` has
/// the vertex of each corner. Faces with a mark in `skipped` are left out. O(H log H).
void for_each_repeated_face(const Buffer<Index>& offsets, const Buffer<Index>& names,
                            const Buffer<std::uint8_t>& skipped, const std::function<void(Index, Index, bool)>& visit);

}  // namespace batten
