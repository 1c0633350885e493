#include "batten/expand/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "batten/error.h"
#include "batten/expand/noise.h"
#include "batten/mesh/face_normal.h"
#include "batten/mesh/measures.h"
#include "batten/mesh/sides.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// The unit normals and areas of the faces.
struct FaceNormals {
  Points normals;
  Eigen::VectorXd areas;
};

FaceNormals face_normals(const Topology& topology, ConstValuesRef points) {
  FaceNormals faces{Points(topology.face_count(), 3), Eigen::VectorXd(topology.face_count())};
  parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t f = begin; f < end; ++f) {
      const Eigen::Vector3d normal = face_normal(topology, points, static_cast<Index>(f));
      const double length = normal.norm();
      faces.areas[f] = 0.5 * length;
      faces.normals.row(f) = (length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero()).transpose();
    }
  });
  return faces;
}

/// One pass: averages each normal with those of its neighbours, weighted by how similar they are.
Points smoothed(const Topology& topology, const FaceNormals& faces, double likeness) {
  Points next(faces.normals.rows(), 3);
  parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const Eigen::RowVector3d own = faces.normals.row(f);
      Eigen::RowVector3d sum = faces.areas[f] * own;
      for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
        const Index twin = topology.twin(h);
        if (twin < 0 || topology.edge_sharpness(topology.edge(h)) > 0.0F) continue;
        const Index g = topology.face(twin);
        const double apart = (faces.normals.row(g) - own).squaredNorm();
        sum += faces.areas[g] * std::exp(-apart / (2.0 * likeness * likeness)) * faces.normals.row(g);
      }
      const double length = sum.norm();
      next.row(f) = length > 0.0 ? Eigen::RowVector3d(sum / length) : own;
    }
  });
  return next;
}

/// The edges, not yet tagged, between faces whose normals differ by more than an angle.
std::vector<Index> sharp_edges(const Topology& topology, const FaceNormals& faces, double least_cosine) {
  std::vector<Index> sharp;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    if (topology.edge_sharpness(e) > 0.0F) continue;
    const Index h = topology.edge_half_edge(e);
    const Index f = topology.face(h);
    const Index g = topology.face(topology.twin(h));
    if (!(faces.areas[f] > 0.0) || !(faces.areas[g] > 0.0)) continue;
    if (faces.normals.row(f).dot(faces.normals.row(g)) < least_cosine) sharp.push_back(e);
  }
  return sharp;
}

/// Creases of the edges that are in connected sets of so many at least.
std::vector<Crease> connected_creases(const Topology& topology, const std::vector<Index>& sharp, int least_edges) {
  DisjointSets sets(static_cast<std::size_t>(topology.vertex_count()));
  for (const Index e : sharp) {
    const Index h = topology.edge_half_edge(e);
    sets.join(topology.origin(h), topology.destination(h));
  }
  std::vector<int> sizes(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (const Index e : sharp) ++sizes[sets.root(topology.origin(topology.edge_half_edge(e)))];
  std::vector<Crease> creases;
  for (const Index e : sharp) {
    const Index h = topology.edge_half_edge(e);
    if (sizes[sets.root(topology.origin(h))] >= least_edges)
      creases.push_back({topology.origin(h), topology.destination(h), kInfiniteSharpness});
  }
  return creases;
}

/// Noise of so many mean edges does not mislead the comparison of smoothed normals.
constexpr double kHarmless = 0.1;

/// Points from which so much noise is smoothed away that kHarmless is left.
struct QuietPoints {
  Points points;
  bool smoothed = false;
};

QuietPoints quiet_points(const Topology& topology, ConstValuesRef points, const Progress& progress) {
  constexpr double kNoisy = 0.06;  // of the mean edge
  constexpr int kSharpness = 2;    // keeps edges best
  constexpr int kStops[] = {2, 3, 4, 6, 8, 12, 16, 24, 32};
  if (topology.vertex_count() < kFewestForNoise) return {points};
  Scheme scheme;
  scheme.kind = topology.uniform_face_size() == 3 ? SchemeKind::Loop : SchemeKind::CatmullClark;
  const MeshSeries series(topology, scheme, {}, progress_within(progress, 0.0, 0.3));
  const Values normals =
      limit_normals(topology, scheme, points, LimitMasks::Exact, progress_within(progress, 0.3, 0.4)).vertices;
  const double noise = estimate_noise(series, points, normals, progress_within(progress, 0.4, 0.6)).deviation;
  const double edge = edge_lengths(topology, points).mean;
  if (!(noise > kNoisy * edge)) return {points};
  Values now = with_random_signs(points);
  const auto done = [&](int passes) { return 0.6 + 0.4 * passes / *std::rbegin(kStops); };
  int passes = 0;
  for (const int stop : kStops) {
    now = series.smooth(now, kSharpness, stop - passes, progress_within(progress, done(passes), done(stop)));
    passes = stop;
    // The last column is what is left of noise of deviation 1.
    if (noise * std::sqrt(now.col(3).squaredNorm() / static_cast<double>(now.rows())) <= kHarmless * edge) break;
  }
  return {now.leftCols(3), true};
}

/// Takes away the short ends that hang on a curve of sharp edges: noise makes them, and where they begin no vertex
/// would be smoothed. `sharp`: edges of the topology.
void prune(const Topology& topology, std::vector<Index>& sharp) {
  constexpr int kShort = 4;
  constexpr int kRounds = 4;
  Buffer<std::uint8_t> is_sharp(static_cast<std::size_t>(topology.edge_count()), 0);
  Buffer<Index> count(static_cast<std::size_t>(topology.vertex_count()), 0);
  const auto mark = [&](Index e, std::uint8_t on) {
    const Index h = topology.edge_half_edge(e);
    is_sharp[e] = on;
    for (const Index v : {topology.origin(h), topology.destination(h)}) count[v] += on != 0 ? 1 : -1;
  };
  for (const Index e : sharp) mark(e, 1);
  const auto next_edge = [&](Index vertex, Index before) {
    Index found = -1;
    topology.for_each_outgoing(vertex, [&](Index h) {
      const Index e = topology.edge(h);
      if (e != before && is_sharp[e] != 0) found = e;
    });
    return found;
  };
  for (int round = 0; round < kRounds; ++round) {
    for (Index start = 0; start < topology.vertex_count(); ++start) {
      if (count[start] != 1) continue;
      std::vector<Index> path;
      Index vertex = start;
      Index edge = -1;
      do {
        edge = next_edge(vertex, edge);
        path.push_back(edge);
        const Index h = topology.edge_half_edge(edge);
        vertex = topology.origin(h) == vertex ? topology.destination(h) : topology.origin(h);
      } while (count[vertex] == 2 && path.size() < kShort);
      if (count[vertex] <= 2 || path.size() >= kShort) continue;
      for (const Index e : path) mark(e, 0);
    }
  }
  std::erase_if(sharp, [&](Index e) { return is_sharp[e] == 0; });
}

}  // namespace

std::vector<Crease> find_features(const Topology& topology, ConstValuesRef points, const FeatureOptions& options,
                                  const Progress& progress) {
  require_vertex_rows(topology, points);
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "sharp edges need points of three columns");
  if (!(options.degrees > 0.0) || !(options.degrees < 180.0))
    throw Error(ErrorCode::BadArgument, "the angle of a sharp edge must be between 0 and 180 degrees");
  const double angle = options.degrees * std::numbers::pi / 180.0;
  const QuietPoints quiet = quiet_points(topology, points, progress_within(progress, 0.0, 0.6));
  FaceNormals faces = face_normals(topology, quiet.points);
  // Half of the distance between two unit normals at that angle. Across a sharp edge the weight is e^-2 or less.
  const double likeness = std::sin(0.5 * angle);
  for (int pass = 0; pass < options.normal_passes; ++pass) {
    report_progress(progress, 0.6 + 0.4 * static_cast<double>(pass) / options.normal_passes);
    faces.normals = smoothed(topology, faces, likeness);
  }
  std::vector<Index> sharp = sharp_edges(topology, faces, std::cos(angle));
  if (quiet.smoothed) prune(topology, sharp);
  return connected_creases(topology, sharp, quiet.smoothed ? 2 * options.least_edges : options.least_edges);
}

}  // namespace batten
