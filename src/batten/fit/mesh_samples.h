/// \file Points spread over a mesh, with normals, for a fit to a mesh.
#pragma once
#include <numbers>

#include "batten/buffer.h"
#include "batten/fit/point_cloud.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// Where a sample of a mesh lies.
enum class SampleKind : std::uint8_t {
  Face,
  Crease,   ///< on an edge tagged as sharp, or bent by more than MeshSampleOptions::sharp_angle
  Boundary  ///< on an edge of one face
};

/// Options of sample_mesh().
struct MeshSampleOptions {
  /// Edges whose faces turn by more than this are creases, in radians, whatever their tags; pi: tagged ones alone.
  double sharp_angle = std::numbers::pi;
};

/// Row i is sample i: first those on faces, then creases, then boundaries.
struct MeshSamples {
  Points points;             ///< N-by-3
  Points normals;            ///< of length 1: of the face; on a crease the mean of both; zero where a face has none
  Buffer<SampleKind> kinds;  ///< N
  Buffer<Index> faces;       ///< N: the face that the sample lies on, one of two on a crease
  double spacing = 0.0;      ///< the distance of samples along creases and boundaries: sqrt(area / count)
};

/// Spreads `count` samples by area over the faces, which are split as triangulate_face() does, and others at about the
/// same distance along creases and boundaries. The k-th sample lies where k + 1/2 of count parts of the area are
/// reached, face after face, at a place in its triangle that a low-discrepancy sequence gives (Roberts 2018, key R18):
/// the same samples each time. Holes are left out. O(H + count), threaded. Throws Error: what Topology throws;
/// BadArgument (no area, a count below 1 or above 100 million, an angle out of [0, pi]), Cancelled.
MeshSamples sample_mesh(const Mesh& mesh, Index count, const MeshSampleOptions& options = {},
                        const Progress& progress = {});

/// So many samples that a surface of `vertices` control points follows them: 12 for each, 10,000 to 200,000.
Index sample_count(Index vertices);

/// The points of a file that a surface of `vertices` control points shall follow: of a mesh sample_count(vertices)
/// samples; without faces its points, with the normals that it states. Throws as sample_mesh().
PointCloud cloud_of_mesh(const Mesh& mesh, Index vertices);

}  // namespace batten
