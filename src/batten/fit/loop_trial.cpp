#include "batten/fit/loop_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {

namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();
constexpr std::size_t kMostNeighbours = 12;

bool has(const std::vector<Index>& list, Index value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

LoopTrial::LoopTrial(const LoopState& state, double fairness, FacetStencils& stencils)
    : state_(&state), fairness_(fairness), surface_(stencils) {}

bool LoopTrial::collapse_allowed(Index a, Index b) const {
  const std::vector<Index> around_a = state_->neighbours(a);
  const std::vector<Index> around_b = state_->neighbours(b);
  std::vector<Index> common;
  std::set_intersection(around_a.begin(), around_a.end(), around_b.begin(), around_b.end(), std::back_inserter(common));
  const std::size_t faces = state_->faces_at(a, b).size();
  if (common.size() != faces) return false;
  const bool boundary_a = state_->is_boundary(a);
  const bool boundary_b = state_->is_boundary(b);
  if (boundary_a && boundary_b && faces != 1) return false;
  const std::size_t merged = around_a.size() + around_b.size() - common.size() - 2;
  if (merged > kMostNeighbours || merged < (boundary_a || boundary_b ? 2U : 3U)) return false;
  for (const Index v : common) {
    if (state_->neighbours(v).size() < 4) return false;
  }
  // Lines of sharp edges neither meet nor vanish: the edge is part of one, or one end is on none.
  const std::size_t sharp_a = state_->sharp_neighbours(a).size() + (boundary_a ? 2 : 0);
  const std::size_t sharp_b = state_->sharp_neighbours(b).size() + (boundary_b ? 2 : 0);
  if (sharp_a > 0 && sharp_b > 0 && !state_->is_sharp(a, b) && faces == 2) return false;
  for (const Index v : common) {
    if (state_->is_sharp(a, v) && state_->is_sharp(b, v)) return false;
  }
  return sharp_a < 3 || sharp_b < 3;
}

bool LoopTrial::is_allowed(const LoopMove& move) const {
  if (!state_->has_vertex(move.a)) return false;
  if (move.kind == LoopMoveKind::Place) return true;
  if (!state_->has_vertex(move.b)) return false;
  const std::vector<Index> faces = state_->faces_at(move.a, move.b);
  if (faces.empty()) return false;
  if (move.kind == LoopMoveKind::Collapse) return collapse_allowed(move.a, move.b);
  if (move.kind == LoopMoveKind::Sharpen) return faces.size() == 2;
  const auto crowded = [&](Index v) { return state_->neighbours(v).size() >= kMostNeighbours; };
  if (move.kind == LoopMoveKind::Split) {
    return std::none_of(faces.begin(), faces.end(),
                        [&](Index f) { return crowded(state_->across(f, move.a, move.b)); });
  }
  if (faces.size() != 2 || state_->is_sharp(move.a, move.b)) return false;
  const Index c = state_->across(faces[0], move.a, move.b);
  const Index d = state_->across(faces[1], move.a, move.b);
  if (c == d || !state_->faces_at(c, d).empty() || crowded(c) || crowded(d)) return false;
  const auto lone = [&](Index v) { return state_->neighbours(v).size() < 4; };
  return !lone(move.a) && !lone(move.b);
}

/// The faces within three rings.
void LoopTrial::gather(std::span<const Index> seeds) {
  face_mark_.resize(static_cast<std::size_t>(state_->face_end()), 0);
  local_of_.resize(static_cast<std::size_t>(state_->vertex_end()) + 1, -1);
  ++round_;
  faces_.clear();
  const auto take_around = [&](Index v) {
    for (const Index f : state_->fan(v)) {
      if (face_mark_[f] == round_) continue;
      face_mark_[f] = round_;
      faces_.push_back(f);
    }
  };
  for (const Index v : seeds) take_around(v);
  for (int ring = 1; ring < 3; ++ring) {
    const std::size_t count = faces_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::array<Index, 3> corners = state_->face(faces_[i]);
      for (const Index v : corners) take_around(v);
    }
  }
}

void LoopTrial::edit(const LoopMove& move) {
  edited_.clear();
  dropped_.clear();
  const Index a = move.a;
  const Index b = move.b;
  for (const Index f : faces_) edited_.push_back({state_->face(f), f, false});
  if (move.kind == LoopMoveKind::Place || move.kind == LoopMoveKind::Sharpen) return;
  const std::size_t count = edited_.size();
  const std::vector<Index> beside = state_->faces_at(a, b);
  for (std::size_t i = 0; i < count; ++i) {
    EditedFace& face = edited_[i];
    const bool here = has(beside, face.id);
    if (move.kind == LoopMoveKind::Collapse) {
      if (here) {
        dropped_.push_back(face.id);
      } else {
        const bool around_a = std::find(face.corners.begin(), face.corners.end(), a) != face.corners.end();
        const auto found = std::find(face.corners.begin(), face.corners.end(), b);
        face.fresh = around_a || found != face.corners.end();
        if (found != face.corners.end()) *found = a;
      }
    } else if (here && move.kind == LoopMoveKind::Split) {
      const Index middle = state_->vertex_end();
      face.fresh = true;
      EditedFace other{face.corners, -1, true};
      std::replace(face.corners.begin(), face.corners.end(), b, middle);
      std::replace(other.corners.begin(), other.corners.end(), a, middle);
      edited_.push_back(other);
    } else if (here) {
      const Index c = state_->across(beside[0], a, b);
      const Index d = state_->across(beside[1], a, b);
      // Each face keeps one end of the old edge.
      const bool first = face.id == beside[0];
      face.fresh = true;
      std::replace(face.corners.begin(), face.corners.end(), first ? b : a, first ? d : c);
    }
  }
  if (dropped_.empty()) return;
  edited_.erase(
      std::remove_if(edited_.begin(), edited_.end(), [&](const EditedFace& face) { return has(dropped_, face.id); }),
      edited_.end());
}

bool LoopTrial::edited_sharp(Index u, Index v) const {
  const Index a = move_.a;
  const Index b = move_.b;
  const Index middle = state_->vertex_end();
  if (u == middle || v == middle) {
    const Index other = u == middle ? v : u;
    return (other == a || other == b) && state_->is_sharp(a, b);
  }
  const bool sharp = state_->is_sharp(u, v);
  if (move_.kind == LoopMoveKind::Collapse && (u == a || v == a)) return sharp || state_->is_sharp(u == a ? v : u, b);
  if (move_.kind == LoopMoveKind::Sharpen && std::minmax(u, v) == std::minmax(a, b)) return !sharp;
  return sharp;
}

/// The faces whose surface changes first, then those around them; others go.
void LoopTrial::order_faces() {
  near_mark_.resize(static_cast<std::size_t>(state_->vertex_end()) + 1, 0);
  for (const Index v : free_) near_mark_[v] = round_;
  ordered_.clear();
  taken_.assign(edited_.size(), 0);
  for (int ring = 0; ring < 3; ++ring) {
    const std::size_t before = ordered_.size();
    for (std::size_t i = 0; i < edited_.size(); ++i) {
      const std::array<Index, 3>& c = edited_[i].corners;
      if (taken_[i] != 0 || std::none_of(c.begin(), c.end(), [&](Index v) { return near_mark_[v] == round_; }))
        continue;
      taken_[i] = 1;
      ordered_.push_back(edited_[i]);
    }
    if (ring == 1) local_.asked = static_cast<Index>(ordered_.size());
    if (ring == 2) break;
    for (std::size_t i = before; i < ordered_.size(); ++i) {
      for (const Index v : ordered_[i].corners) near_mark_[v] = round_;
    }
  }
  edited_.swap(ordered_);
}

void LoopTrial::build() {
  vertices_.clear();
  local_.faces.resize(edited_.size());
  local_.sharp.assign(3 * edited_.size(), 0);
  places_.clear();
  for (std::size_t f = 0; f < edited_.size(); ++f) {
    for (int c = 0; c < 3; ++c) {
      const Index v = edited_[f].corners[c];
      if (local_of_[v] < 0) {
        local_of_[v] = static_cast<Index>(vertices_.size());
        vertices_.push_back(v);
        FreePlace place;
        const auto found = std::find(free_.begin(), free_.end(), v);
        if (found != free_.end()) {
          place.weights[static_cast<std::size_t>(found - free_.begin())] = 1.0;
        } else {
          for (int k = 0; k < 3; ++k) place.fixed[k] = state_->place(v)[k];
        }
        places_.push_back(place);
      }
      local_.faces[f][c] = local_of_[v];
      local_.sharp[3 * f + c] = edited_sharp(v, edited_[f].corners[(c + 1) % 3]) ? 1 : 0;
    }
  }
  for (const Index v : vertices_) local_of_[v] = -1;
  surface_.refine(local_, places_);
}

void LoopTrial::gather_points() {
  points_.clear();
  const auto take = [&](Index face, Index first) {
    for (const Index point : state_->points_of(face)) {
      const FacetAttachment& attached = state_->attachment(point);
      points_.push_back({point, first < 0 ? -1 : first + attached.facet, attached.square});
    }
  };
  for (Index f = 0; f < local_.asked; ++f) {
    const EditedFace& face = edited_[static_cast<std::size_t>(f)];
    if (face.id >= 0) take(face.id, face.fresh ? -1 : kFacetsOfFace * f);
  }
  for (const Index face : dropped_) take(face, -1);
}

double LoopTrial::gain(const LoopMove& move, int steps) {
  if (!is_allowed(move)) return kNever;
  move_ = move;
  const std::array<Index, 2> ends{move.a, move.b};
  gather(std::span<const Index>(ends).first(move.kind == LoopMoveKind::Place ? 1 : 2));
  edit(move);
  const Eigen::Vector3d a = state_->place(move.a);
  free_ = {move.a};
  free_place_ = {a};
  if (move.kind == LoopMoveKind::Split) {
    free_ = {state_->vertex_end()};
    free_place_ = {0.5 * (a + state_->place(move.b))};
  } else if (move.kind == LoopMoveKind::Collapse) {
    const std::size_t fixed_a = state_->sharp_neighbours(move.a).size();
    const std::size_t fixed_b = state_->sharp_neighbours(move.b).size();
    const double share = fixed_a == fixed_b ? 0.5 : fixed_a > fixed_b ? 0.0 : 1.0;
    free_place_ = {a + share * (state_->place(move.b) - a)};
  } else if (move.kind == LoopMoveKind::Sharpen) {
    free_.push_back(move.b);
    free_place_.push_back(state_->place(move.b));
  } else if (move.kind == LoopMoveKind::Swap) {
    free_.clear();
    free_place_.clear();
    for (const Index f : state_->faces_at(move.a, move.b)) {
      free_.push_back(state_->across(f, move.a, move.b));
      free_place_.push_back(state_->place(free_.back()));
    }
  }
  order_faces();
  build();
  gather_points();
  find_bends();
  double before = bends_before();
  for (const LocalPoint& point : points_) before += point.square;
  const double after = optimize(steps);
  if (!std::isfinite(after) || (folds() && !folded_before())) return kNever;
  return before - after;
}

void LoopTrial::commit(LoopState& state) const {
  const bool sharp = move_.kind != LoopMoveKind::Place && state.is_sharp(move_.a, move_.b);
  const std::vector<Index> sharp_of_b =
      move_.kind == LoopMoveKind::Collapse ? state.sharp_neighbours(move_.b) : std::vector<Index>();
  if (move_.kind == LoopMoveKind::Split) state.add_vertex(free_place_[0]);
  std::vector<Index> ids;
  for (const EditedFace& face : edited_) {
    if (face.id < 0) {
      ids.push_back(state.add_face(face.corners));
    } else {
      ids.push_back(face.id);
      if (state.face(face.id) != face.corners) state.set_face(face.id, face.corners);
    }
  }
  for (std::size_t k = 0; k < free_.size(); ++k) state.move_vertex(free_[k], free_place_[k]);
  for (const LocalPoint& point : points_)
    state.attach(point.point, {ids[static_cast<std::size_t>(point.facet / kFacetsOfFace)], point.facet % kFacetsOfFace,
                               point.square});
  for (const Index face : dropped_) state.drop_face(face);
  if (move_.kind == LoopMoveKind::Sharpen) state.set_sharp(move_.a, move_.b, !sharp);
  if (move_.kind == LoopMoveKind::Split && sharp) {
    const Index middle = free_[0];
    state.set_sharp(move_.a, move_.b, false);
    state.set_sharp(move_.a, middle, true);
    state.set_sharp(middle, move_.b, true);
  }
  for (const Index other : sharp_of_b) {
    state.set_sharp(move_.b, other, false);
    if (other != move_.a) state.set_sharp(move_.a, other, true);
  }
}

}  // namespace batten
