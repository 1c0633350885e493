/// \file Faces that stand twice in a mesh.
#pragma once
#include <functional>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// Visits faces that have the same vertices around: visit(first, later, same_direction), the lowest face first. `names`
/// has the vertex of each corner; faces with a mark in `skipped` are left out. O(H log H).
void for_each_repeated_face(const Buffer<Index>& offsets, const Buffer<Index>& names,
                            const Buffer<std::uint8_t>& skipped, const std::function<void(Index, Index, bool)>& visit);

}  // namespace batten
