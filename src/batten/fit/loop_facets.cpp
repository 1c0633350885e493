#include "batten/fit/loop_facets.h"

#include <algorithm>

namespace batten {

namespace {

constexpr int kCornerBits = 5;
constexpr std::size_t kMostAround = 20;  ///< edges at a corner whose surroundings have a key
constexpr int kChannels = 3 + kMostFree;

/// A face with all triangles around it, laid out so that nothing meets itself beyond them; vertices are numbered as
/// FacetStencils::Weights lists control points.
class LaidOutRing {
 public:
  explicit LaidOutRing(const TriangleRing& ring) : ring_(ring) {
    faces_.asked = 1;
    // Where only three triangles meet at a corner one vertex is across two sides.
    for (int c = 0; c < 3; ++c) {
      if (!corner(c).open && corner(c).onward == 1)
        across_[c] = across_[before(c)] = std::min(across_[c], across_[before(c)]);
    }
    add(0, 1, 2, sharp(0, 0), sharp(1, 0), sharp(2, 0));
    for (int side = 0; side < 3; ++side) add_across(side);
    for (int c = 0; c < 3; ++c) add_fan(c);
  }

  const LocalFaces& faces() const { return faces_; }
  Index vertex_count() const { return next_; }

 private:
  static int after(int c) { return (c + 1) % 3; }
  static int before(int c) { return (c + 2) % 3; }
  const TriangleRing::Corner& corner(int c) const { return ring_.corners[static_cast<std::size_t>(c)]; }
  int sharp(int c, int edge) const { return corner(c).sharp[static_cast<std::size_t>(edge)]; }

  void add(Index a, Index b, Index c, int of_ab, int of_bc, int of_ca) {
    faces_.faces.push_back({a, b, c});
    for (const int flag : {of_ab, of_bc, of_ca}) faces_.sharp.push_back(static_cast<std::uint8_t>(flag));
  }

  /// From the corner that a side starts at, the edge to the vertex across is the last one onward or the first one back.
  void add_across(int side) {
    if (corner(after(side)).onward == 0) return;
    const TriangleRing::Corner& from = corner(side);
    add(after(side), side, across_[side], sharp(side, 0), sharp(side, (from.open ? 2 : 1) + from.onward),
        sharp(after(side), 2));
  }

  void add_fan(int c) {
    const TriangleRing::Corner& at = corner(c);
    Index last = across_[before(c)];
    for (int i = 1; i < at.onward; ++i) {
      const Index vertex = !at.open && i + 1 == at.onward ? across_[c] : next_++;
      add(c, last, vertex, sharp(c, 1 + i), 0, sharp(c, 2 + i));
      last = vertex;
    }
    last = across_[c];
    for (int i = 1; i < at.back; ++i) {
      add(c, next_, last, sharp(c, 2 + at.onward + i), 0, sharp(c, 1 + at.onward + i));
      last = next_++;
    }
  }

  const TriangleRing& ring_;
  LocalFaces faces_;
  std::array<Index, 3> across_{3, 4, 5};
  Index next_ = 6;
};

/// From a triangle alone, whose facets are numbered as those of all.
FacetStencils::Pattern make_pattern() {
  LocalFaces single;
  single.faces = {{0, 1, 2}};
  single.sharp.assign(3, 0);
  single.asked = 1;
  LocalLoop refined;
  refined.refine(single, std::vector<LocalValues>(3));
  FacetStencils::Pattern pattern{};
  std::vector<Index> number(refined.limits().size(), -1);
  Index next = 0;
  for (Index facet = 0; facet < kFacetsOfFace; ++facet) {
    for (int c = 0; c < 3; ++c) {
      Index& place = number[static_cast<std::size_t>(refined.facet(facet)[static_cast<std::size_t>(c)])];
      if (place < 0) place = next++;
      pattern.corners[facet][c] = place;
      pattern.across[facet][c] = refined.across(facet, c);
    }
  }
  for (int side = 0; side < 3; ++side) {
    // The first half of a side is that of a child at its side 0, the second one of the next child at its side 2.
    const int after = (side + 1) % 3;
    const std::array<std::array<int, 3>, 4> parts{{{side, 0, 0}, {side, 1, 2}, {after, 2, 0}, {after, 0, 2}}};
    for (int place = 0; place < 4; ++place) {
      const Index facet = 4 * parts[place][0] + parts[place][1];
      pattern.along[side][place] = facet;
      pattern.side_of_face[facet][parts[place][2]] = side;
      pattern.place_on_side[facet][parts[place][2]] = place;
    }
  }
  return pattern;
}

}  // namespace

std::size_t FacetStencils::KeyHash::operator()(const Key& key) const {
  std::uint64_t hash = 0;
  for (const std::uint32_t part : key) hash = (hash ^ part) * 0x9e3779b97f4a7c15ULL;
  return static_cast<std::size_t>(hash ^ hash >> 32);
}

FacetStencils::FacetStencils() : pattern_(make_pattern()) {}

bool FacetStencils::find_key(const TriangleRing& ring, Key& key) {
  for (std::size_t c = 0; c < 3; ++c) {
    const TriangleRing::Corner& corner = ring.corners[c];
    if (corner.sharp.size() > kMostAround) return false;
    std::uint32_t bits = corner.open ? 1 : 0;
    bits = bits << kCornerBits | static_cast<std::uint32_t>(corner.onward);
    bits = bits << kCornerBits | static_cast<std::uint32_t>(corner.back);
    for (const std::uint8_t sharp : corner.sharp) bits = bits << 1 | sharp;
    key[c] = bits;
  }
  return true;
}

const FacetStencils::Weights& FacetStencils::at(const Key& key, const TriangleRing& ring) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = known_.find(key);
  return found != known_.end() ? found->second : known_.emplace(key, made(ring)).first->second;
}

/// Each control point has a channel of LocalLoop, in as many goes as that takes.
FacetStencils::Weights FacetStencils::made(const TriangleRing& ring) const {
  const LaidOutRing laid_out(ring);
  const Index count = laid_out.vertex_count();
  constexpr auto kAtOnce = static_cast<Index>(LocalValues{}.size());
  LocalLoop refined;
  Weights weights(static_cast<std::size_t>(count));
  for (Index first = 0; first < count; first += kAtOnce) {
    const Index last = std::min(count, first + kAtOnce);
    std::vector<LocalValues> values(static_cast<std::size_t>(count), LocalValues{});
    for (Index v = first; v < last; ++v) values[static_cast<std::size_t>(v)][static_cast<std::size_t>(v - first)] = 1.0;
    refined.refine(laid_out.faces(), values);
    for (Index facet = 0; facet < kFacetsOfFace; ++facet) {
      for (std::size_t c = 0; c < 3; ++c) {
        const LocalValues& limit = refined.limits()[static_cast<std::size_t>(refined.facet(facet)[c])];
        const auto place = static_cast<std::size_t>(pattern_.corners[static_cast<std::size_t>(facet)][c]);
        for (Index v = first; v < last; ++v)
          weights[static_cast<std::size_t>(v)][place] = limit[static_cast<std::size_t>(v - first)];
      }
    }
  }
  return weights;
}

Index LoopFacets::across(Index number, int side) const {
  const FacetStencils::Pattern& pattern = stencils_.pattern();
  const Index face = number / kFacetsOfFace;
  const auto facet = static_cast<std::size_t>(number % kFacetsOfFace);
  const Index inside = pattern.across[facet][side];
  if (inside >= 0) return kFacetsOfFace * face + inside;
  const Index twin = twins_[3 * static_cast<std::size_t>(face) + pattern.side_of_face[facet][side]];
  if (twin < 0 || twin / 3 >= asked_) return -1;
  return kFacetsOfFace * (twin / 3) +
         pattern.along[static_cast<std::size_t>(twin % 3)][3 - pattern.place_on_side[facet][side]];
}

bool LoopFacets::is_sharp(Index number, int side) const {
  const FacetStencils::Pattern& pattern = stencils_.pattern();
  const auto facet = static_cast<std::size_t>(number % kFacetsOfFace);
  return pattern.across[facet][side] < 0 &&
         sharp_[3 * static_cast<std::size_t>(number / kFacetsOfFace) + pattern.side_of_face[facet][side]] != 0;
}

/// Goes around a corner of a face, first from the edge to its last corner on, then, where a boundary is in the way,
/// from the edge to its next one back.
void LoopFacets::walk(const LocalFaces& control, Index face, int corner) {
  TriangleRing::Corner& ring = ring_.corners[static_cast<std::size_t>(corner)];
  std::vector<Index>& onward = onward_[static_cast<std::size_t>(corner)];
  std::vector<Index>& back = back_[static_cast<std::size_t>(corner)];
  onward.clear();
  back.clear();
  const auto start = static_cast<Index>(3 * face + corner);
  const auto is_sharp = [&](Index h) { return static_cast<std::uint8_t>(sharp_[h] != 0 || twins_[h] < 0 ? 1 : 0); };
  const auto origin = [&](Index h) { return control.faces[static_cast<std::size_t>(h / 3)][h % 3]; };
  ring.sharp.assign({is_sharp(start), is_sharp(last_in_face(start))});
  Index h = twins_[last_in_face(start)];
  for (; h >= 0 && h != start; h = twins_[last_in_face(h)]) {
    onward.push_back(origin(last_in_face(h)));
    ring.sharp.push_back(is_sharp(last_in_face(h)));
  }
  ring.open = h < 0;
  if (!ring.open) {
    // The way on has come to the face's next corner, which is counted already.
    onward.pop_back();
    ring.sharp.pop_back();
  } else {
    for (Index twin = twins_[start]; twin >= 0; twin = twins_[next_in_face(twin)]) {
      back.push_back(origin(last_in_face(twin)));
      ring.sharp.push_back(is_sharp(next_in_face(twin)));
    }
  }
  ring.onward = static_cast<int>(onward.size());
  ring.back = static_cast<int>(back.size());
}

/// The control point across a side belongs to both ends of the side, and is listed once.
void LoopFacets::name_columns(const LocalFaces& control, Index face) {
  const std::array<Index, 3>& own = control.faces[static_cast<std::size_t>(face)];
  columns_.assign(own.begin(), own.end());
  for (int side = 0; side < 3; ++side) {
    const Index twin = twins_[3 * static_cast<std::size_t>(face) + side];
    columns_.push_back(twin < 0 ? -1 : control.faces[static_cast<std::size_t>(twin / 3)][last_in_face(twin) % 3]);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const bool closes = !ring_.corners[c].open;
    for (std::size_t i = 1; i + (closes ? 1 : 0) < onward_[c].size(); ++i) columns_.push_back(onward_[c][i]);
    for (std::size_t i = 1; i < back_[c].size(); ++i) columns_.push_back(back_[c][i]);
  }
}

const FacetStencils::Weights& LoopFacets::weights() {
  FacetStencils::Key key{};
  if (!FacetStencils::find_key(ring_, key)) return rare_ = stencils_.made(ring_);
  const auto found = known_.find(key);
  return found != known_.end() ? *found->second : *known_.emplace(key, &stencils_.at(key, ring_)).first->second;
}

void LoopFacets::place(Index face, std::span<const FreePlace> places, const FacetStencils::Weights& weights) {
  std::array<LocalValues, kChannels> sums{};
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i] < 0) continue;
    const LocalValues& of = weights[i];
    const FreePlace& from = places[static_cast<std::size_t>(columns_[i])];
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < of.size(); ++k) sums[c][k] += of[k] * from.fixed[c];
    }
    for (std::size_t c = 0; c < kMostFree; ++c) {
      if (from.weights[c] == 0.0) continue;
      for (std::size_t k = 0; k < of.size(); ++k) sums[3 + c][k] += of[k] * from.weights[c];
    }
  }
  for (std::size_t k = 0; k < kPlacesOfFace; ++k) {
    FreePlace& to = places_[static_cast<std::size_t>(kPlacesOfFace * face) + k];
    to.fixed = {sums[0][k], sums[1][k], sums[2][k]};
    for (std::size_t c = 0; c < kMostFree; ++c) to.weights[c] = sums[3 + c][k];
  }
}

void LoopFacets::refine(const LocalFaces& control, std::span<const FreePlace> places) {
  asked_ = control.asked;
  sharp_ = control.sharp;
  places_.resize(static_cast<std::size_t>(kPlacesOfFace) * asked_);
  find_twins(control.faces, twins_, ends_);
  for (Index face = 0; face < asked_; ++face) {
    for (int corner = 0; corner < 3; ++corner) walk(control, face, corner);
    name_columns(control, face);
    place(face, places, weights());
  }
}

}  // namespace batten
