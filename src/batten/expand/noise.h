/// \file Measures the noise of a mesh and chooses how much smoothing removes it and keeps the shape.
#pragma once
#include "batten/expand/mesh_series.h"

namespace batten {

/// Noise that moves each vertex independently and equally in all directions.
struct NoiseEstimate {
  double deviation = 0.0;  ///< standard deviation along the normal, in the unit of the points
  Index vertices = 0;      ///< the number of vertices measured: smooth ones that are not kept
};

/// The median of |n . (G^4 points)| over the smooth vertices, divided by the same median for noise of deviation 1. G^4
/// leaves almost nothing of smooth shapes, and sharp features do not change a median (Donoho and Johnstone 1994, key
/// DJ94). On meshes so coarse that the shape turns within two or three edges, the shape counts as noise too.
/// points: V-by-3; normals: V-by-3, of unit length. Throws Error(BadShape, NotFinite, Cancelled).
NoiseEstimate estimate_noise(const MeshSeries& series, ConstValuesRef points, ConstValuesRef normals,
                             const Progress& progress = {});

/// A choice of MeshSeries::smooth's parameters.
struct SmoothingChoice {
  int m = 2;
  int passes = 0;
  double removed = 0.0;         ///< root mean square, along the normals, of what this choice removes
  double removed_noise = 0.0;   ///< the same for noise of the estimated deviation alone
  double expected_error = 0.0;  ///< root mean square, along the normals, of the expected remaining error
};

/// The m in {0, 1, 2} and the number of passes in 0 .. 800 with the least expected error. The error follows from what
/// is removed and from what noise of this deviation would lose (Stein's unbiased estimate, 1981, key S81; its trace is
/// estimated with one vector of random signs, the same at every run). Up to 4,800 applications of A, a few dozen if
/// there is little noise. Throws as estimate_noise does.
SmoothingChoice choose_smoothing(const MeshSeries& series, ConstValuesRef points, ConstValuesRef normals,
                                 double deviation, const Progress& progress = {});

/// The points with a fourth column of random signs, the same at every run: after smoothing, its mean square is what is
/// left of noise of variance 1, and its product with the signs before estimates the trace of the smoothing.
Values with_random_signs(ConstValuesRef points);

/// The root mean square, along the normals, of the error to expect of a choice, over all vertices, those on creases and
/// corners too. Estimated as in choose_smoothing, so that smoothings of the same points under other creases can be
/// compared. Throws as estimate_noise does.
double expected_error(const MeshSeries& series, ConstValuesRef points, ConstValuesRef normals, double deviation,
                      const SmoothingChoice& choice, const Progress& progress = {});

}  // namespace batten
