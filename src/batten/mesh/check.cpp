#include "batten/mesh/check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace batten {

namespace {

/// A side of a face, keyed by its lower and higher vertex.
struct Side {
  Index low;
  Index high;
  Index face;
  bool forward;  ///< from low to high
  bool operator<(const Side& other) const {
    if (low != other.low) return low < other.low;
    if (high != other.high) return high < other.high;
    return face < other.face;
  }
  bool same_edge(const Side& other) const { return low == other.low && high == other.high; }
};

class Checker {
 public:
  Checker(const Mesh& mesh, std::size_t limit) : mesh_(mesh), limit_(limit) {}

  std::vector<MeshProblem> run() {
    if (check_arrays()) {
      check_points();
      if (check_faces()) {
        gather_sides();
        check_repeated_faces();
        check_edges();
        check_vertices();
        check_tags();
      }
    }
    return std::move(problems_);
  }

 private:
  void report(ErrorCode kind, const std::string& message) {
    if (reported_[kind]++ < limit_) problems_.push_back({kind, message});
  }
  static std::string edge_name(Index a, Index b) {
    return "edge (" + std::to_string(a) + ", " + std::to_string(b) + ")";
  }
  Index corner(Index face, Index i) const { return mesh_.face_vertices[mesh_.face_offsets[face] + i]; }

  bool check_arrays() {
    const auto& offsets = mesh_.face_offsets;
    if (mesh_.face_vertices.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max())) {
      report(ErrorCode::TooLarge, "the mesh has more than 2^31 - 1 face corners; split it");
    } else if (offsets.empty() || offsets.front() != 0 || !std::is_sorted(offsets.begin(), offsets.end()) ||
               static_cast<std::size_t>(offsets.back()) != mesh_.face_vertices.size()) {
      report(ErrorCode::BadShape, "face_offsets must start with 0, not decrease, and end with the number of corners, " +
                                      std::to_string(mesh_.face_vertices.size()));
    }
    return problems_.empty();
  }

  void check_points() {
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (mesh_.points.row(v).allFinite()) continue;
      report(ErrorCode::NotFinite, "vertex " + std::to_string(v) + " has a coordinate that is not a finite number");
    }
  }

  bool check_faces() {
    bool usable = true;
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      const Index size = mesh_.face_size(f);
      const std::string name = "face " + std::to_string(f);
      if (size < 3) {
        report(ErrorCode::DegenerateFace, name + " has only " + std::to_string(size) + " corners; remove it");
        usable = false;
        continue;
      }
      Buffer<Index> sorted(&mesh_.face_vertices[mesh_.face_offsets[f]],
                           &mesh_.face_vertices[mesh_.face_offsets[f]] + size);
      std::sort(sorted.begin(), sorted.end());
      if (sorted.front() < 0 || sorted.back() >= mesh_.vertex_count()) {
        const Index bad = sorted.front() < 0 ? sorted.front() : sorted.back();
        report(ErrorCode::IndexOutOfRange, name + " names vertex " + std::to_string(bad) + ", but there are only " +
                                               std::to_string(mesh_.vertex_count()) + " (counted from 0)");
        usable = false;
      }
      const auto repeated = std::adjacent_find(sorted.begin(), sorted.end());
      if (repeated != sorted.end()) {
        report(ErrorCode::DegenerateFace,
               name + " uses vertex " + std::to_string(*repeated) + " twice; remove the face or weld less");
        usable = false;
      }
    }
    return usable;
  }

  void gather_sides() {
    sides_.reserve(mesh_.face_vertices.size());
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      const Index size = mesh_.face_size(f);
      for (Index i = 0; i < size; ++i) {
        const Index a = corner(f, i);
        const Index b = corner(f, i + 1 == size ? 0 : i + 1);
        sides_.push_back({std::min(a, b), std::max(a, b), f, a < b});
      }
    }
    std::sort(sides_.begin(), sides_.end());
  }

  /// The face's vertices from its lowest one on, in its order.
  std::vector<Index> canonical(Index face) const {
    const Index* first = &mesh_.face_vertices[mesh_.face_offsets[face]];
    std::vector<Index> cycle(first, first + mesh_.face_size(face));
    std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
    return cycle;
  }

  template <typename Visit>
  void for_each_edge(const Visit& visit) const {
    for (std::size_t i = 0; i < sides_.size();) {
      std::size_t j = i + 1;
      while (j < sides_.size() && sides_[j].same_edge(sides_[i])) ++j;
      visit(i, j);
      i = j;
    }
  }

  void check_repeated_faces() {
    // Equal faces share every directed edge, so they meet in a side that stands twice in one direction.
    std::set<Index> suspects;
    for_each_edge([&](std::size_t i, std::size_t j) {
      for (std::size_t a = i; a < j && j - i < 64; ++a) {
        for (std::size_t b = i; b < a; ++b) {
          if (sides_[a].forward == sides_[b].forward) suspects.insert({sides_[a].face, sides_[b].face});
        }
      }
    });
    std::map<std::vector<Index>, Index> seen;
    for (const Index f : suspects) {
      const auto [place, is_new] = seen.emplace(canonical(f), f);
      if (is_new) continue;
      report(ErrorCode::RepeatedFace, "face " + std::to_string(f) + " has the same vertices as face " +
                                          std::to_string(place->second) + "; remove one of them");
    }
  }

  void check_edges() {
    bool flipped = false;
    for_each_edge([&](std::size_t i, std::size_t j) {
      const Side& side = sides_[i];
      if (j - i > 2) {
        report(ErrorCode::NonManifoldEdge,
               edge_name(side.low, side.high) + " has " + std::to_string(j - i) +
                   " faces; at most two can meet in an edge: give each sheet its own copy " + "of the two vertices");
      } else if (j - i == 2 && side.forward == sides_[i + 1].forward) {
        flipped = true;
      }
    });
    if (flipped) explain_flipped_neighbours();
  }

  /// Two-colours the faces so that neighbours agree; where that fails the component is non-orientable.
  void explain_flipped_neighbours() {
    std::vector<std::vector<std::pair<Index, bool>>> neighbours(static_cast<std::size_t>(mesh_.face_count()));
    for_each_edge([&](std::size_t i, std::size_t j) {
      if (j - i != 2) return;
      const bool flip = sides_[i].forward == sides_[i + 1].forward;
      neighbours[sides_[i].face].push_back({sides_[i + 1].face, flip});
      neighbours[sides_[i + 1].face].push_back({sides_[i].face, flip});
    });
    std::vector<int> colour(neighbours.size(), -1);
    for (Index seed = 0; seed < mesh_.face_count(); ++seed) {
      if (colour[seed] >= 0) continue;
      colour[seed] = 0;
      std::vector<Index> members{seed};
      bool orientable = true;
      for (std::size_t k = 0; k < members.size(); ++k) {
        const Index f = members[k];
        for (const auto& link : neighbours[f]) {
          const int wanted = colour[f] ^ (link.second ? 1 : 0);
          if (colour[link.first] < 0) {
            colour[link.first] = wanted;
            members.push_back(link.first);
          } else if (colour[link.first] != wanted && orientable) {
            orientable = false;
            report(ErrorCode::NonOrientable,
                   "the faces around face " + std::to_string(link.first) +
                       " have no consistent orientation (like a Moebius strip); cut the surface along a closed curve");
          }
        }
      }
      if (orientable) report_flipped(std::move(members), colour);
    }
  }

  void report_flipped(std::vector<Index> members, const std::vector<int>& colour) {
    const auto odd = std::count_if(members.begin(), members.end(), [&](Index f) { return colour[f] == 1; });
    if (odd == 0) return;
    const int minority = 2 * odd <= static_cast<std::ptrdiff_t>(members.size()) ? 1 : 0;
    std::sort(members.begin(), members.end());
    for (const Index f : members) {
      if (colour[f] != minority) continue;
      report(ErrorCode::InconsistentFaces,
             "face " + std::to_string(f) + " turns the other way than its neighbours; reverse its vertices");
    }
  }

  /// Only where the edges hold: counts the fans of faces at each vertex.
  void check_vertices() {
    if (!problems_.empty()) return;
    std::map<std::pair<Index, Index>, Index> face_of;  // directed edge -> face
    std::vector<std::vector<Index>> faces_at(static_cast<std::size_t>(mesh_.vertex_count()));
    for (const Side& side : sides_) {
      face_of[side.forward ? std::pair(side.low, side.high) : std::pair(side.high, side.low)] = side.face;
    }
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      for (Index i = 0; i < mesh_.face_size(f); ++i) faces_at[corner(f, i)].push_back(f);
    }
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      const std::size_t fans = count_fans(v, faces_at[v], face_of);
      if (fans <= 1) continue;
      report(ErrorCode::NonManifoldVertex, "vertex " + std::to_string(v) + " joins " + std::to_string(fans) +
                                               " separate fans of faces; give each fan its own copy of the vertex");
    }
  }

  std::size_t count_fans(Index v, const std::vector<Index>& faces,
                         const std::map<std::pair<Index, Index>, Index>& face_of) const {
    std::map<Index, Index> parent;
    for (const Index f : faces) parent[f] = f;
    const auto root = [&](Index f) {
      while (parent[f] != f) f = parent[f] = parent[parent[f]];
      return f;
    };
    for (const Index f : faces) {
      const Index size = mesh_.face_size(f);
      Index i = 0;
      while (corner(f, i) != v) ++i;
      const auto twin = face_of.find({corner(f, i + 1 == size ? 0 : i + 1), v});
      if (twin != face_of.end()) parent[root(f)] = root(twin->second);
    }
    return static_cast<std::size_t>(std::count_if(faces.begin(), faces.end(), [&](Index f) { return root(f) == f; }));
  }

  void check_tags() {
    const auto exists = [&](Index v) { return v >= 0 && v < mesh_.vertex_count(); };
    for (std::size_t i = 0; i < mesh_.creases.size(); ++i) {
      const Crease& crease = mesh_.creases[i];
      const std::string name = "crease " + std::to_string(i) + " on " + edge_name(crease.a, crease.b);
      const Side wanted{std::min(crease.a, crease.b), std::max(crease.a, crease.b), -1, true};
      const auto side = std::lower_bound(sides_.begin(), sides_.end(), wanted);
      if (!std::isfinite(crease.sharpness)) {
        report(ErrorCode::NotFinite, name + " has a sharpness that is not a finite number");
      } else if (!exists(crease.a) || !exists(crease.b)) {
        report(ErrorCode::IndexOutOfRange, name + " names a vertex that does not exist");
      } else if (side == sides_.end() || !side->same_edge(wanted)) {
        report(ErrorCode::BadArgument, name + ": no face has this edge; remove the tag");
      }
    }
    for (const Corner& tag : mesh_.corners) {
      const std::string name = "the corner tag on vertex " + std::to_string(tag.vertex);
      if (!std::isfinite(tag.sharpness)) {
        report(ErrorCode::NotFinite, name + " has a sharpness that is not a finite number");
      } else if (!exists(tag.vertex)) {
        report(ErrorCode::IndexOutOfRange, name + " names a vertex that does not exist");
      }
    }
    for (const Index face : mesh_.holes) {
      if (face >= 0 && face < mesh_.face_count()) continue;
      report(ErrorCode::IndexOutOfRange, "the hole tag names face " + std::to_string(face) + ", which does not exist");
    }
  }

  const Mesh& mesh_;
  std::size_t limit_;
  std::map<ErrorCode, std::size_t> reported_;
  std::vector<MeshProblem> problems_;
  std::vector<Side> sides_;
};

}  // namespace

std::vector<MeshProblem> check(const Mesh& mesh, std::size_t limit) { return Checker(mesh, limit).run(); }

}  // namespace batten
