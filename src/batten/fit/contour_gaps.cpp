#include "batten/fit/contour_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "batten/fit/contour_parts.h"
#include "batten/mesh/repair.h"
#include "batten/mesh/topology.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// How far each face is from the samples.
struct FaceReach {
  Buffer<double> distance;
  Buffer<std::uint8_t> far;  ///< farther than gaps between samples explain, or beyond their end
};

FaceReach face_reach(const Mesh& mesh, const CloudField& field, double face_size) {
  constexpr double kFarSpacings = 3.0;
  constexpr double kFarFaces = 0.5;
  constexpr Index kAround = 12;
  constexpr Index kFewest = 6;
  constexpr double kLean = 0.5;  // 4 / (3 pi) = 0.42 where the samples end in a straight line
  const Index around = std::clamp<Index>(field.tree.size() / 8, 1, kAround);
  FaceReach reach;
  reach.distance.resize(static_cast<std::size_t>(mesh.face_count()));
  reach.far.resize(reach.distance.size());
  const auto measure = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto face = static_cast<Index>(begin); face < end; ++face) {
      Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
      for (Index c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c)
        middle += mesh.points.row(mesh.face_vertices[c]);
      middle /= mesh.face_size(face);
      std::array<Index, kAround> near{};
      std::array<double, kAround> squares{};
      const Index found = field.tree.nearest(middle, around, near.data(), squares.data());
      Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
      for (Index k = 0; k < found; ++k) mean += field.samples.points.row(near[k]);
      const double lean = (mean / found - middle).norm() / std::sqrt(squares[found - 1]);
      reach.distance[face] = std::sqrt(squares[0]);
      const double local = std::max(field.samples.spacing(near[0]), field.samples.typical);
      const bool away = reach.distance[face] > std::max(kFarSpacings * local, kFarFaces * face_size);
      reach.far[face] = away || (found > kFewest && lean > kLean) ? 1 : 0;
    }
  };
  parallel_for(mesh.face_count(), measure, 256);
  return reach;
}

/// Takes the marks off groups of far faces that are no wider than the bridge.
void close_narrow(const Topology& topology, FaceReach& reach, double bridge) {
  Buffer<std::uint8_t> seen(reach.far.size(), 0);
  std::vector<Index> group;
  for (Index start = 0; start < topology.face_count(); ++start) {
    if (reach.far[start] == 0 || seen[start] != 0) continue;
    group.assign(1, start);
    seen[start] = 1;
    double widest = 0.0;
    for (std::size_t at = 0; at < group.size(); ++at) {
      widest = std::max(widest, reach.distance[group[at]]);
      for (Index h = topology.face_begin(group[at]); h < topology.face_end(group[at]); ++h) {
        const Index twin = topology.twin(h);
        if (twin < 0 || reach.far[topology.face(twin)] == 0 || seen[topology.face(twin)] != 0) continue;
        seen[topology.face(twin)] = 1;
        group.push_back(topology.face(twin));
      }
    }
    if (2.0 * widest > bridge) continue;
    for (const Index face : group) reach.far[face] = 0;
  }
}

/// How many edges of a face have a kept face on the other side.
Index kept_sides(const Topology& topology, const Buffer<std::uint8_t>& kept, Index face) {
  Index count = 0;
  for (Index h = topology.face_begin(face); h < topology.face_end(face); ++h)
    count += topology.twin(h) >= 0 && kept[topology.face(topology.twin(h))] != 0 ? 1 : 0;
  return count;
}

/// True where the kept faces at a vertex are several fans.
bool is_pinched(const Topology& topology, const Buffer<std::uint8_t>& kept, Index vertex) {
  Index changes = 0;
  topology.for_each_outgoing(vertex, [&](Index h) {
    const Index twin = topology.twin(h);
    if (twin < 0) return;
    changes += kept[topology.face(h)] != kept[topology.face(twin)] ? 1 : 0;
  });
  return changes > 2;
}

/// Fills notches, drops faces that hang on by one edge, fills around pinched vertices.
void smooth_marks(const Topology& topology, Buffer<std::uint8_t>& kept) {
  constexpr int kRounds = 20;
  bool any = true;
  for (int round = 0; any && round < kRounds; ++round) {
    any = false;
    for (Index face = 0; face < topology.face_count(); ++face) {
      const Index sides = kept_sides(topology, kept, face);
      const bool keep = kept[face] != 0 ? sides > 1 : sides + 1 >= topology.face_size(face);
      if (keep == (kept[face] != 0)) continue;
      kept[face] = keep ? 1 : 0;
      any = true;
    }
    for (Index vertex = 0; vertex < topology.vertex_count(); ++vertex) {
      if (!is_pinched(topology, kept, vertex)) continue;
      topology.for_each_outgoing(vertex, [&](Index h) { kept[topology.face(h)] = 1; });
      any = true;
    }
  }
}

}  // namespace

Index cut_gaps(Mesh& mesh, const CloudField& field, double face_size, double bridge) {
  FaceReach reach = face_reach(mesh, field, face_size);
  const Topology topology(mesh);
  close_narrow(topology, reach, bridge);
  Buffer<std::uint8_t> kept(reach.far.size());
  for (std::size_t face = 0; face < kept.size(); ++face) kept[face] = reach.far[face] != 0 ? 0 : 1;
  const auto count = static_cast<Index>(std::count(kept.begin(), kept.end(), 0));
  if (count == 0) return 0;
  smooth_marks(topology, kept);
  keep_faces(mesh, kept);
  mesh = repair(mesh, {.weld = -1.0}).mesh;
  return count;
}

}  // namespace batten
