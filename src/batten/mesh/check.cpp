#include "batten/mesh/check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/mesh/repeated_faces.h"
#include "batten/mesh/sides.h"
#include "batten/progress.h"

namespace batten {

namespace {

using Side = SideTable::Side;

std::string edge_name(Index a, Index b) {
  return "edge (" + std::to_string(std::min(a, b)) + ", " + std::to_string(std::max(a, b)) + ")";
}

/// Collects problems by kind.
class Findings {
 public:
  explicit Findings(std::size_t limit) : limit_(limit) {}

  /// Calls message() only if the result is kept.
  template <typename Message>
  void add(ErrorCode kind, const Message& message) {
    auto place =
        std::find_if(problems_.begin(), problems_.end(), [&](const auto& known) { return known.kind == kind; });
    if (place == problems_.end()) place = problems_.insert(place, {kind, 0, {}});
    if (place->count++ < limit_) place->messages.push_back(message());
  }
  std::vector<MeshProblem> take() { return std::move(problems_); }

 private:
  std::size_t limit_;
  std::vector<MeshProblem> problems_;
};

/// True if the arrays can be read at all.
bool check_arrays(const Mesh& mesh, Findings& findings) {
  const auto& offsets = mesh.face_offsets;
  if (mesh.face_vertices.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max())) {
    findings.add(ErrorCode::TooLarge, [] { return "the mesh has more than 2^31 - 1 face corners; split it"; });
    return false;
  }
  if (!offsets.empty() && offsets.front() == 0 && std::is_sorted(offsets.begin(), offsets.end()) &&
      static_cast<std::size_t>(offsets.back()) == mesh.face_vertices.size()) {
    return true;
  }
  findings.add(ErrorCode::BadShape, [&] {
    return "face_offsets must start with 0, not decrease, and end with the number of corners, " +
           std::to_string(mesh.face_vertices.size());
  });
  return false;
}

void check_points(const Mesh& mesh, Findings& findings) {
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.points.row(v).allFinite()) continue;
    findings.add(ErrorCode::NotFinite,
                 [&] { return "vertex " + std::to_string(v) + " has a coordinate that is not a finite number"; });
  }
}

/// Marks the faces that are wrong by themselves.
Buffer<std::uint8_t> check_faces(const Mesh& mesh, Findings& findings) {
  Buffer<std::uint8_t> wrong(static_cast<std::size_t>(mesh.face_count()), 0);
  Buffer<Index> sorted;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index size = mesh.face_size(f);
    const auto name = [&] { return "face " + std::to_string(f); };
    if (size < 3) {
      findings.add(ErrorCode::DegenerateFace,
                   [&] { return name() + " has only " + std::to_string(size) + " corners; remove it"; });
      wrong[f] = 1;
      continue;
    }
    const Index* first = &mesh.face_vertices[mesh.face_offsets[f]];
    sorted.assign(first, first + size);
    std::sort(sorted.begin(), sorted.end());
    if (sorted.front() < 0 || sorted.back() >= mesh.vertex_count()) {
      findings.add(ErrorCode::IndexOutOfRange, [&] {
        return name() + " names vertex " + std::to_string(sorted.front() < 0 ? sorted.front() : sorted.back()) +
               ", but there are only " + std::to_string(mesh.vertex_count()) + " (counted from 0)";
      });
      wrong[f] = 1;
    }
    const auto repeated = std::adjacent_find(sorted.begin(), sorted.end());
    if (repeated != sorted.end()) {
      findings.add(ErrorCode::DegenerateFace, [&] {
        return name() + " uses vertex " + std::to_string(*repeated) + " twice; remove the face or weld less";
      });
      wrong[f] = 1;
    }
  }
  return wrong;
}

void check_repeated_faces(const Mesh& mesh, const Buffer<std::uint8_t>& wrong, Findings& findings) {
  std::vector<std::pair<Index, Index>> repeated;  // the later face, then the first one
  for_each_repeated_face(mesh.face_offsets, mesh.face_vertices, wrong, [&](Index first, Index later, bool same_way) {
    if (same_way) repeated.emplace_back(later, first);
  });
  std::sort(repeated.begin(), repeated.end());
  for (const auto& pair : repeated) {
    findings.add(ErrorCode::RepeatedFace, [&] {
      return "face " + std::to_string(pair.first) + " has the same vertices as face " + std::to_string(pair.second) +
             "; remove one of them";
    });
  }
}

void check_edges(const SideTable& sides, Findings& findings) {
  sides.for_each_edge([&](const Side* first, const Side* last) {
    if (last - first <= 2) return;
    findings.add(ErrorCode::NonManifoldEdge, [&] {
      return edge_name(sides.from(first->corner), sides.to(first->corner)) + " has " + std::to_string(last - first) +
             " faces; at most two can meet in an edge: give each sheet its own copy of the two vertices";
    });
  });
}

void check_orientation(const SideTable& sides, Findings& findings) {
  const Orientation orientation = orient(sides, pair_sides(sides));
  Buffer<std::uint8_t> torn(static_cast<std::size_t>(orientation.component_count), 0);
  for (const Index side : orientation.conflicts) {
    const Index face = sides.face(side);
    if (torn[orientation.component[face]] != 0) continue;
    torn[orientation.component[face]] = 1;
    findings.add(ErrorCode::NonOrientable, [&] {
      return "the faces around face " + std::to_string(face) +
             " have no consistent orientation (like a Moebius strip); cut the surface along a closed curve";
    });
  }
  for (Index f = 0; f < sides.face_count(); ++f) {
    if (orientation.reversed[f] == 0 || torn[orientation.component[f]] != 0) continue;
    findings.add(ErrorCode::InconsistentFaces, [&] {
      return "face " + std::to_string(f) + " turns the other way than its neighbours; reverse its vertices";
    });
  }
}

/// Finds vertices whose faces are not all connected through edges at the vertex, however many faces share an edge.
void check_vertices(const Mesh& mesh, const SideTable& sides, Findings& findings) {
  DisjointSets corners(mesh.face_vertices.size());
  Buffer<Index> fans(static_cast<std::size_t>(mesh.vertex_count()), 0);
  sides.for_each_edge([&](const Side* first, const Side* last) {
    const Index a = first->corner;
    for (const Side* side = first + 1; side != last; ++side) {
      const Index b = side->corner;
      const bool same_way = sides.from(a) == sides.from(b);
      corners.join(a, same_way ? b : sides.next(b));
      corners.join(sides.next(a), same_way ? sides.next(b) : b);
    }
  });
  for (const Side& side : sides.sorted()) {
    if (corners.root(side.corner) == side.corner) ++fans[sides.from(side.corner)];
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (fans[v] <= 1) continue;
    findings.add(ErrorCode::NonManifoldVertex, [&] {
      return "vertex " + std::to_string(v) + " joins " + std::to_string(fans[v]) +
             " separate fans of faces; give each fan its own copy of the vertex";
    });
  }
}

void check_creases(const Mesh& mesh, const SideTable& sides, Findings& findings) {
  const auto exists = [&](Index v) { return v >= 0 && v < mesh.vertex_count(); };
  for (std::size_t i = 0; i < mesh.creases.size(); ++i) {
    const Crease& crease = mesh.creases[i];
    const auto name = [&] { return "crease " + std::to_string(i) + " on " + edge_name(crease.a, crease.b); };
    const Side wanted{SideTable::edge_key(crease.a, crease.b), -1};
    const auto side = std::lower_bound(sides.sorted().begin(), sides.sorted().end(), wanted);
    if (!std::isfinite(crease.sharpness)) {
      findings.add(ErrorCode::NotFinite, [&] { return name() + " has a sharpness that is not a finite number"; });
    } else if (!exists(crease.a) || !exists(crease.b)) {
      findings.add(ErrorCode::IndexOutOfRange, [&] { return name() + " names a vertex that does not exist"; });
    } else if (side == sides.sorted().end() || side->edge != wanted.edge) {
      findings.add(ErrorCode::BadArgument, [&] { return name() + ": no face has this edge; remove the tag"; });
    }
  }
}

void check_corners_and_holes(const Mesh& mesh, Findings& findings) {
  for (const Corner& tag : mesh.corners) {
    const auto name = [&] { return "the corner tag on vertex " + std::to_string(tag.vertex); };
    if (!std::isfinite(tag.sharpness)) {
      findings.add(ErrorCode::NotFinite, [&] { return name() + " has a sharpness that is not a finite number"; });
    } else if (tag.vertex < 0 || tag.vertex >= mesh.vertex_count()) {
      findings.add(ErrorCode::IndexOutOfRange, [&] { return name() + " names a vertex that does not exist"; });
    }
  }
  for (const Index face : mesh.holes) {
    if (face >= 0 && face < mesh.face_count()) continue;
    findings.add(ErrorCode::IndexOutOfRange,
                 [&] { return "the hole tag names face " + std::to_string(face) + ", which does not exist"; });
  }
}

}  // namespace

std::vector<MeshProblem> check(const Mesh& mesh, std::size_t limit, const Progress& progress) {
  Findings findings(limit);
  if (!check_arrays(mesh, findings)) return findings.take();
  check_points(mesh, findings);
  report_progress(progress, 0.1);
  const Buffer<std::uint8_t> wrong = check_faces(mesh, findings);
  report_progress(progress, 0.2);
  check_repeated_faces(mesh, wrong, findings);
  report_progress(progress, 0.4);
  const SideTable sides(mesh.face_offsets, mesh.face_vertices, wrong);
  report_progress(progress, 0.6);
  check_edges(sides, findings);
  check_orientation(sides, findings);
  report_progress(progress, 0.8);
  check_vertices(mesh, sides, findings);
  check_creases(mesh, sides, findings);
  check_corners_and_holes(mesh, findings);
  return findings.take();
}

}  // namespace batten
