/// \file How much noise a mesh has, and how much smoothing takes the noise and leaves the shape.
#pragma once
#include "batten/expand/mesh_series.h"

namespace batten {

/// Noise that moves each vertex on its own, as far in any direction.
struct NoiseEstimate {
  double deviation = 0.0;  ///< standard deviation along the normal, in the unit of the points
  Index vertices = 0;      ///< how many it was measured at: smooth ones that are not kept
};

/// The median of |n . (G^4 points)| over the smooth vertices, over what the same median is of noise of deviation 1: G^4
/// leaves nearly nothing of smooth shapes, and what sharp features leave moves no median (Donoho and Johnstone 1994,
/// key DJ94). On meshes so coarse that the shape turns within two or three edges, the shape counts as noise too.
/// points: V-by-3; normals: V-by-3, of unit length. Throws Error(BadShape, NotFinite, Cancelled).
NoiseEstimate estimate_noise(const MeshSeries& series, ConstValuesRef points, ConstValuesRef normals,
                             const Progress& progress = {});

/// A choice of MeshSeries::smooth's parameters.
struct SmoothingChoice {
  int m = 2;
  int passes = 0;
  double removed = 0.0;         ///< root mean square along the normals of what this choice removes
  double removed_noise = 0.0;   ///< the same of noise of that deviation alone
  double expected_error = 0.0;  ///< root mean square along the normals that is expected to be left
};

/// The m in {0, 1, 2} and the number of passes, 0 .. 800, with the least expected error: what is removed, beside what
/// noise of this deviation would lose (Stein's unbiased estimate, 1981, key S81; its trace by one vector of random
/// signs, the same at every run). Takes up to 4,800 applications of A, a few dozen where there is little noise. Throws
/// as estimate_noise.
SmoothingChoice choose_smoothing(const MeshSeries& series, ConstValuesRef points, ConstValuesRef normals,
                                 double deviation, const Progress& progress = {});

}  // namespace batten
