/// \file Control points that move towards the mean of their neighbours, where a surface folds or could not go on.
#pragma once
#include <cstdint>

#include "batten/buffer.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// The inner control points that `held` flags, one flag each, moved along the surface, or along their sharp line,
/// towards the mean of their neighbours, of those on the line; those at the ends and crossings of lines stay. control:
/// V-by-3.
Values relaxed_along(const Topology& topology, const Scheme& scheme, Values control, const Buffer<std::uint8_t>& held);

/// The inner control points of the faces that are flagged, one flag a face, moved this part of the way to that mean.
Values evened_out(const Topology& topology, const Values& control, const Buffer<std::uint8_t>& faces, double part);

}  // namespace batten
