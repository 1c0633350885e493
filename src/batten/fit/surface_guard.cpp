#include "batten/fit/surface_guard.h"

#include <algorithm>
#include <limits>

#include "batten/mesh/face_normal.h"
#include "batten/mesh/self_intersections.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// The cosine of the angle between normals of facets side by side; narrow bends at sharp edges turn by less.
constexpr double kFolded = -0.3;

Topology facets_of(const Tessellator& tessellator) {
  Mesh mesh;
  mesh.points = Points::Zero(tessellator.vertex_count(), 3);
  mesh.face_vertices.resize(static_cast<std::size_t>(tessellator.face_count()) * tessellator.face_size());
  tessellator.faces(mesh.face_vertices);
  mesh.face_offsets.clear();
  for (Index f = 0; f <= tessellator.face_count(); ++f) mesh.face_offsets.push_back(f * tessellator.face_size());
  return Topology(mesh);
}

/// Facets come base face by base face, without those of holes.
Buffer<Index> faces_of_facets(const SurfacePatches& patches, const Tessellator& tessellator) {
  Buffer<Index> faces;
  const Index each = tessellator.steps() * tessellator.steps();
  for (Index f = 0; f < patches.base().face_count(); ++f) {
    if (!patches.base().is_hole(f)) faces.insert(faces.end(), each, patches.control_face(f));
  }
  return faces;
}

}  // namespace

SurfaceGuard::SurfaceGuard(const SurfacePatches& patches, int levels)
    : tessellator_(patches, levels + (patches.has_first_step() ? 1 : 0)),
      facets_(facets_of(tessellator_)),
      faces_(faces_of_facets(patches, tessellator_)),
      control_faces_(patches.topology().face_count()) {}

Buffer<std::uint8_t> SurfaceGuard::unsound(ConstValuesRef control, Soundness asked,
                                           const Buffer<std::uint8_t>& known) const {
  Points points(tessellator_.vertex_count(), 3);
  tessellator_.limit(control, std::span<double>(points.data(), static_cast<std::size_t>(points.size())));
  Buffer<std::uint8_t> flags = folded(points);
  if (asked == Soundness::Unfolded) return flags;
  for (std::size_t f = 0; f < known.size(); ++f) {
    if (flags[f] != 0 && known[f] == 0) return flags;
  }
  const SelfIntersections crossing =
      find_self_intersections(facets_, points, Progress(), std::numeric_limits<Index>::max());
  for (const auto& pair : crossing.faces) flags[faces_[pair[0]]] = flags[faces_[pair[1]]] = 1;
  return flags;
}

Buffer<std::uint8_t> SurfaceGuard::folded(const Points& points) const {
  Buffer<std::uint8_t> flags(static_cast<std::size_t>(control_faces_), 0);
  Points normals(facets_.face_count(), 3);
  parallel_for(facets_.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < static_cast<Index>(end); ++f)
      normals.row(f) = face_normal(facets_, points, f).transpose();
  });
  for (Index e = 0; e < facets_.edge_count(); ++e) {
    if (facets_.is_boundary_edge(e)) continue;
    const Index one = facets_.face(facets_.edge_half_edge(e));
    const Index other = facets_.face(facets_.twin(facets_.edge_half_edge(e)));
    if (faces_[one] != faces_[other]) continue;
    const double lengths = normals.row(one).norm() * normals.row(other).norm();
    if (normals.row(one).dot(normals.row(other)) < kFolded * lengths) flags[faces_[one]] = 1;
  }
  return flags;
}

}  // namespace batten
