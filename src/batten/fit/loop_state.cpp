#include "batten/fit/loop_state.h"

#include <algorithm>

#include "batten/mesh/topology.h"
#include "batten/nearest/nearest_point.h"

namespace batten {

namespace {

/// The facet of a triangle at shares b of its corners, as LocalLoop numbers facets: two steps down.
Index facet_at(std::array<double, 3> b) {
  Index facet = 0;
  for (int level = 0; level < 2; ++level) {
    const auto largest = static_cast<int>(std::max_element(b.begin(), b.end()) - b.begin());
    if (b[largest] >= 0.5) {
      const double next = 2.0 * b[(largest + 1) % 3];
      const double last = 2.0 * b[(largest + 2) % 3];
      facet = 4 * facet + largest;
      b = {1.0 - next - last, next, last};
    } else {
      facet = 4 * facet + 3;
      b = {1.0 - 2.0 * b[2], 1.0 - 2.0 * b[0], 1.0 - 2.0 * b[1]};
    }
  }
  return facet;
}

void erase_one(std::vector<Index>& list, Index value) {
  const auto found = std::find(list.begin(), list.end(), value);
  if (found != list.end()) list.erase(found);
}

}  // namespace

LoopState::LoopState(const Mesh& mesh, const Points& points) : points_(points) {
  const auto count = static_cast<std::size_t>(points.rows());
  attached_.resize(count);
  for (Index v = 0; v < mesh.vertex_count(); ++v) add_vertex(mesh.points.row(v).transpose());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index* const c = mesh.face_vertices.data() + mesh.face_offsets[f];
    add_face({c[0], c[1], c[2]});
  }
  for (const Crease& crease : mesh.creases) set_sharp(crease.a, crease.b, true);
  attach_all();
}

bool LoopState::is_sharp(Index a, Index b) const {
  return std::find(sharp_[a].begin(), sharp_[a].end(), b) != sharp_[a].end();
}

std::vector<Index> LoopState::neighbours(Index v) const {
  std::vector<Index> others;
  for (const Index f : fans_[v]) {
    for (const Index other : faces_[f]) {
      if (other != v) others.push_back(other);
    }
  }
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  return others;
}

std::vector<Index> LoopState::faces_at(Index a, Index b) const {
  std::vector<Index> found;
  for (const Index f : fans_[a]) {
    if (std::find(faces_[f].begin(), faces_[f].end(), b) != faces_[f].end()) found.push_back(f);
  }
  return found;
}

Index LoopState::across(Index f, Index a, Index b) const {
  for (const Index v : faces_[f]) {
    if (v != a && v != b) return v;
  }
  return -1;
}

std::vector<std::array<Index, 2>> LoopState::edges() const {
  std::vector<std::array<Index, 2>> all;
  for (Index v = 0; v < vertex_end(); ++v) {
    for (const Index other : neighbours(v)) {
      if (v < other) all.push_back({v, other});
    }
  }
  return all;
}

double LoopState::squares() const {
  double sum = 0.0;
  for (const FacetAttachment& attachment : attached_) sum += attachment.square;
  return sum;
}

double LoopState::squares_of(Index f) const {
  double sum = 0.0;
  for (const Index point : points_of_[f]) sum += attached_[point].square;
  return sum;
}

void LoopState::attach_all() {
  std::vector<Index> numbers;
  for (Index f = 0; f < face_end(); ++f) {
    points_of_[f].clear();
    if (has_face(f)) numbers.push_back(f);
  }
  const Mesh now = mesh();
  const NearestPoints nearest(Topology(now), Scheme{SchemeKind::Loop}, now.points);
  std::vector<NearestPoint> found(attached_.size());
  nearest.nearest(points_, found);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const SurfacePlace& place = found[i].place;
    const Index face = numbers[static_cast<std::size_t>(place.face)];
    attached_[i] = {face, facet_at({1.0 - place.u - place.v, place.u, place.v}), found[i].distance * found[i].distance};
    points_of_[face].push_back(static_cast<Index>(i));
  }
}

Mesh LoopState::mesh() const {
  Mesh mesh;
  std::vector<Index> number(places_.size(), -1);
  mesh.points.resize(vertices_, 3);
  Index next = 0;
  for (Index v = 0; v < vertex_end(); ++v) {
    if (!has_vertex(v)) continue;
    mesh.points.row(next) = places_[v].transpose();
    number[v] = next++;
  }
  for (const std::array<Index, 3>& face : faces_) {
    if (face[0] >= 0) mesh.add_face({number[face[0]], number[face[1]], number[face[2]]});
  }
  for (Index v = 0; v < vertex_end(); ++v) {
    for (const Index other : sharp_[v]) {
      if (v < other) mesh.creases.push_back({number[v], number[other], kInfiniteSharpness});
    }
  }
  return mesh;
}

Index LoopState::add_vertex(const Eigen::Vector3d& place) {
  places_.push_back(place);
  fans_.emplace_back();
  sharp_.emplace_back();
  return vertex_end() - 1;
}

Index LoopState::add_face(const std::array<Index, 3>& corners) {
  faces_.push_back({-1, -1, -1});
  points_of_.emplace_back();
  set_face(face_end() - 1, corners);
  return face_end() - 1;
}

void LoopState::drop_face(Index f) {
  for (const Index v : faces_[f]) {
    erase_one(fans_[v], f);
    if (fans_[v].empty()) --vertices_;
  }
  faces_[f] = {-1, -1, -1};
}

void LoopState::set_face(Index f, const std::array<Index, 3>& corners) {
  if (has_face(f)) drop_face(f);
  faces_[f] = corners;
  for (const Index v : corners) {
    if (fans_[v].empty()) ++vertices_;
    fans_[v].push_back(f);
  }
}

void LoopState::set_sharp(Index a, Index b, bool sharp) {
  erase_one(sharp_[a], b);
  erase_one(sharp_[b], a);
  if (!sharp) return;
  sharp_[a].push_back(b);
  sharp_[b].push_back(a);
}

void LoopState::attach(Index point, const FacetAttachment& to) {
  FacetAttachment& now = attached_[point];
  if (now.face != to.face) {
    erase_one(points_of_[now.face], point);
    points_of_[to.face].push_back(point);
  }
  now = to;
}

}  // namespace batten
