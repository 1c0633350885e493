/// \file How the points of a refined regular patch follow from its control points.
#pragma once
#include "batten/buffer.h"
#include "batten/limit/vertex_limit.h"

namespace batten {

/// Weights for a row of size + 1 points, size = 2^steps, of a curve patch with four control points: weight j of point i
/// is at 4 i + j. The tensor product of two gives Catmull-Clark's patch. TangentV is not for curves. Exact but for the
/// division by 6.
Buffer<double> curve_weights(int size, TileValue value);

/// Weights for the points (i, j), i + j <= size, row by row of j, of Loop's patch with twelve control points in the
/// order of kTriangleLattice: weight k of point p is at 12 p + k.
Buffer<double> triangle_weights(int size, TileValue value);

}  // namespace batten
