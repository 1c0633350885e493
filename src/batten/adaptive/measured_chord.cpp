#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "batten/adaptive/adaptive.h"
#include "batten/mesh/segment.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

using Point = Eigen::Vector3d;

struct Distance {
  double value;
  bool above;  ///< the nearest point is inside the triangle
};

Distance distance_to_triangle(const Point& p, const std::array<Point, 3>& corners) {
  const Point normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  bool inside = normal.squaredNorm() > 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Point& a = corners[k];
    const Point& b = corners[(k + 1) % 3];
    inside = inside && normal.cross(b - a).dot(p - a) >= 0.0;
    nearest = std::min(nearest, distance_to_segment(p, a, b));
  }
  return {inside ? std::abs(normal.dot(p - corners[0])) / normal.norm() : nearest, inside};
}

constexpr std::size_t kSampleCount = 7;
constexpr std::array<std::array<double, 3>, kSampleCount> kSamples{{{0.5, 0.5, 0.0},
                                                                    {0.0, 0.5, 0.5},
                                                                    {0.5, 0.0, 0.5},
                                                                    {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0},
                                                                    {2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0},
                                                                    {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0},
                                                                    {1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0}}};

/// Measures distances to a mesh, with the faces around each vertex.
class Meter {
 public:
  Meter(const LimitSurface& surface, const AdaptiveMesh& mesh) : surface_(surface), adaptive_(mesh), mesh_(mesh.mesh) {
    first_.resize(static_cast<std::size_t>(mesh_.vertex_count()) + 1, 0);
    for (const Index v : mesh_.face_vertices) ++first_[v + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    around_.resize(mesh_.face_vertices.size());
    Buffer<Index> next(first_.begin(), first_.end() - 1);
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      for (Index c = mesh_.face_offsets[f]; c < mesh_.face_offsets[f + 1]; ++c) {
        around_[next[mesh_.face_vertices[c]]++] = f;
      }
    }
  }

  /// The greatest distance at samples of one of a face's triangles.
  double worst_of(Index face, Index half) const {
    const std::array<Index, 3> corners{0, half + 1, half + 2};
    const Index first = mesh_.face_offsets[face];
    const double most = surface_.base().uniform_face_size() == 3 ? 0.0 : 1.0;
    double worst = 0.0;
    for (const std::array<double, 3>& weights : kSamples) {
      SurfacePlace place{adaptive_.base_faces[face], 0.0, 0.0};
      for (int k = 0; k < 3; ++k) {
        const std::array<double, 2>& at = adaptive_.corner_parameters[first + corners[k]];
        place.u += weights[k] * at[0];
        place.v += weights[k] * at[1];
      }
      place.v = std::min(place.v, 1.0);
      place.u = std::min(place.u, most == 1.0 ? 1.0 : 1.0 - place.v);
      worst = std::max(worst, nearest(surface_.jet(place).point, face, half));
    }
    return worst;
  }

 private:
  std::array<Point, 3> triangle(Index face, Index half) const {
    const Index* v = &mesh_.face_vertices[mesh_.face_offsets[face]];
    return {mesh_.points.row(v[0]).transpose(), mesh_.points.row(v[half + 1]).transpose(),
            mesh_.points.row(v[half + 2]).transpose()};
  }
  /// The distance to the face's own triangle if the point is above it, otherwise to the nearest of the surrounding ones
  /// too.
  double nearest(const Point& p, Index face, Index half) const {
    const Distance own = distance_to_triangle(p, triangle(face, half));
    if (own.above) return own.value;
    double least = own.value;
    for (Index c = mesh_.face_offsets[face]; c < mesh_.face_offsets[face + 1]; ++c) {
      const Index v = mesh_.face_vertices[c];
      for (Index i = first_[v]; i < first_[v + 1]; ++i) {
        const Index other = around_[i];
        for (Index h = 0; h + 2 < mesh_.face_size(other); ++h) {
          least = std::min(least, distance_to_triangle(p, triangle(other, h)).value);
        }
      }
    }
    return least;
  }

  const LimitSurface& surface_;
  const AdaptiveMesh& adaptive_;
  const Mesh& mesh_;
  Buffer<Index> first_;  ///< the start of each vertex's faces in around_
  Buffer<Index> around_;
};

}  // namespace

double measured_chord(const LimitSurface& surface, const AdaptiveMesh& mesh, const Progress& progress) {
  constexpr std::ptrdiff_t kFacesPerBlock = 256;
  const Meter meter(surface, mesh);
  return parallel_reduce(
      mesh.mesh.face_count(), 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double worst = 0.0;
        for (auto f = static_cast<Index>(begin); f < end; ++f) {
          for (Index half = 0; half + 2 < mesh.mesh.face_size(f); ++half) {
            worst = std::max(worst, meter.worst_of(f, half));
          }
        }
        return worst;
      },
      [](double a, double b) { return std::max(a, b); }, kFacesPerBlock, progress);
}

}  // namespace batten
