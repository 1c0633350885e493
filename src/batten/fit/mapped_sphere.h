/// \file The sphere's control mesh, laid over a cloud of points.
#pragma once
#include <optional>

#include "batten/fit/point_cloud.h"
#include "batten/mesh/mesh.h"
#include "batten/progress.h"

namespace batten {

/// unit_sphere(kind, vertices) with its control points where its surface lies near the points, without having to be
/// drawn there: the surface of the points is laid on the sphere (fit/sphere_map.h), and with it the points, so that
/// the control points follow from a linear system. Where distances are left, the surface gets a larger part of the
/// sphere, and again. cloud: with normals. Nothing where the points give no single closed surface without handles, or
/// where it does not lie on the sphere without folds. The result depends on the points, not on their order, if they
/// are sorted. Throws Error(Cancelled).
std::optional<Mesh> mapped_sphere(const PointCloud& cloud, SchemeKind kind, Index vertices,
                                  const Progress& progress = {});

}  // namespace batten
