#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "batten/adaptive/adaptive.h"
#include "batten/mesh/segment.h"
#include "batten/nearest/lanes.h"
#include "batten/parallel/parallel.h"
#include "batten/progress.h"

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
  for (int k = 0; k < 3; ++k) {
    inside = inside && normal.cross(corners[(k + 1) % 3] - corners[k]).dot(p - corners[k]) >= 0.0;
  }
  if (inside) return {std::abs(normal.dot(p - corners[0])) / normal.norm(), true};
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) nearest = std::min(nearest, distance_to_segment(p, corners[k], corners[(k + 1) % 3]));
  return {nearest, false};
}

constexpr std::size_t kSampleCount = 7;
constexpr std::array<std::array<double, 3>, kSampleCount> kSamples{{{0.5, 0.5, 0.0},
                                                                    {0.0, 0.5, 0.5},
                                                                    {0.5, 0.0, 0.5},
                                                                    {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0},
                                                                    {2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0},
                                                                    {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0},
                                                                    {1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0}}};

/// The samples of one of a face's triangles.
using Samples = std::array<SurfacePlace, kSampleCount>;

Samples samples_of(const AdaptiveMesh& mesh, Index face, Index half, bool quads) {
  Samples samples;
  const std::array<Index, 3> corners{0, half + 1, half + 2};
  const Index first = mesh.mesh.face_offsets[face];
  for (std::size_t i = 0; i < kSampleCount; ++i) {
    SurfacePlace place{mesh.base_faces[face], 0.0, 0.0};
    for (int k = 0; k < 3; ++k) {
      const std::array<double, 2>& at = mesh.corner_parameters[first + corners[k]];
      place.u += kSamples[i][k] * at[0];
      place.v += kSamples[i][k] * at[1];
    }
    place.v = std::min(place.v, 1.0);
    place.u = std::min(place.u, quads ? 1.0 : 1.0 - place.v);
    samples[i] = place;
  }
  return samples;
}

/// Measures distances to a mesh, with the faces around each vertex.
class Meter {
 public:
  explicit Meter(const Mesh& mesh)
      : mesh_(mesh),
        low_(static_cast<std::size_t>(mesh.face_count())),
        high_(static_cast<std::size_t>(mesh.face_count())) {
    first_.resize(static_cast<std::size_t>(mesh_.vertex_count()) + 1, 0);
    for (const Index v : mesh_.face_vertices) ++first_[v + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    around_.resize(mesh_.face_vertices.size());
    Buffer<Index> next(first_.begin(), first_.end() - 1);
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      for (Index c = mesh_.face_offsets[f]; c < mesh_.face_offsets[f + 1]; ++c) {
        around_[next[mesh_.face_vertices[c]]++] = f;
        const auto row = mesh_.points.row(mesh_.face_vertices[c]);
        const Double4 point{row[0], row[1], row[2], 0.0};
        low_[f] = c == mesh_.face_offsets[f] ? point : lower(low_[f], point);
        high_[f] = c == mesh_.face_offsets[f] ? point : higher(high_[f], point);
      }
    }
  }

  /// The greatest of `worst` and the distances of samples of one of a face's triangles.
  double worst_of(Index face, Index half, const Jet* samples, double worst) const {
    for (std::size_t i = 0; i < kSampleCount; ++i) {
      worst = std::max(worst, nearest(samples[i].point, face, half, worst));
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
  /// too. A distance of at most `enough` does not count: then some other such number may come out, without a look at
  /// the many faces around a vertex of high valence.
  double nearest(const Point& p, Index face, Index half, double enough) const {
    const Distance own = distance_to_triangle(p, triangle(face, half));
    if (own.above || own.value <= enough) return own.value;
    double least = own.value;
    const Double4 at{p[0], p[1], p[2], 0.0};
    for (Index c = mesh_.face_offsets[face]; c < mesh_.face_offsets[face + 1]; ++c) {
      const Index v = mesh_.face_vertices[c];
      for (Index i = first_[v]; i < first_[v + 1]; ++i) {
        const Index other = around_[i];
        // Around a vertex of high valence most faces are too far away to be looked at.
        if (squared_distance_of_box(low_[other] - at, high_[other] - at) > kMore * least * least) continue;
        for (Index h = 0; h + 2 < mesh_.face_size(other); ++h) {
          least = std::min(least, distance_to_triangle(p, triangle(other, h)).value);
        }
        if (least <= enough) return least;
      }
    }
    return least;
  }

  static constexpr double kMore = 1.0 + 1e-12;  ///< for what rounding does to distances
  const Mesh& mesh_;
  Buffer<Double4> low_;  ///< of the box around each face
  Buffer<Double4> high_;
  Buffer<Index> first_;  ///< the start of each vertex's faces in around_
  Buffer<Index> around_;
};

/// So many faces at a time: jets are large.
constexpr Index kFacesAtOnce = 1 << 12;

}  // namespace

double measured_chord(const LimitSurface& surface, const AdaptiveMesh& mesh, const Progress& progress) {
  constexpr std::ptrdiff_t kFacesPerBlock = 256;
  const Meter meter(mesh.mesh);
  const bool quads = surface.base().uniform_face_size() != 3;
  std::vector<SurfacePlace> places;
  std::vector<Jet> jets;
  Buffer<std::size_t> starts;
  double worst = 0.0;
  for (Index first = 0; first < mesh.mesh.face_count(); first += kFacesAtOnce) {
    report_progress(progress, static_cast<double>(first) / mesh.mesh.face_count());
    const Index count = std::min(kFacesAtOnce, mesh.mesh.face_count() - first);
    places.clear();
    starts.clear();
    for (Index f = first; f < first + count; ++f) {
      starts.push_back(places.size());
      for (Index half = 0; half + 2 < mesh.mesh.face_size(f); ++half) {
        const Samples samples = samples_of(mesh, f, half, quads);
        places.insert(places.end(), samples.begin(), samples.end());
      }
    }
    jets.resize(places.size());
    surface.jets(places, jets);
    const double worst_here = parallel_reduce(
        count, 0.0,
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          double worst_of_block = 0.0;
          for (auto f = static_cast<Index>(begin); f < end; ++f) {
            const Jet* samples = jets.data() + starts[f];
            for (Index half = 0; half + 2 < mesh.mesh.face_size(first + f); ++half, samples += kSampleCount) {
              worst_of_block = meter.worst_of(first + f, half, samples, worst_of_block);
            }
          }
          return worst_of_block;
        },
        [](double a, double b) { return std::max(a, b); }, kFacesPerBlock);
    worst = std::max(worst, worst_here);
  }
  return worst;
}

}  // namespace batten
