/// \file The facets of LocalLoop by stored stencils: what is around a triangle is alike for many.
#pragma once
#include <array>
#include <cstdint>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "batten/fit/local_loop.h"

namespace batten {

/// At most so many control points are free.
inline constexpr int kMostFree = 2;

/// What a point of the surface is: a fixed place, plus a weight of each free control point.
struct FreePlace {
  std::array<double, 3> fixed{};
  std::array<double, kMostFree> weights{};
};

/// to += weight * from.
inline void add_scaled(double weight, const FreePlace& from, FreePlace& to) {
  for (std::size_t c = 0; c < from.fixed.size(); ++c) to.fixed[c] += weight * from.fixed[c];
  for (std::size_t c = 0; c < from.weights.size(); ++c) to.weights[c] += weight * from.weights[c];
}

/// The corners of a face's facets: so many places.
inline constexpr int kPlacesOfFace = 15;

/// How the triangles around a face lie: those around each of its corners, and which edges to the corner's neighbours
/// are sharp or boundaries.
struct TriangleRing {
  struct Corner {
    int onward = 0;     ///< vertices beyond the face on the way round from the edge to the face's last corner
    int back = 0;       ///< and, where a boundary ends that way, on the way back from the edge to its next one
    bool open = false;  ///< a boundary does
    /// Of the edges to the next and the last corner of the face, to the vertices onward, and to those back.
    std::vector<std::uint8_t> sharp;
  };
  std::array<Corner, 3> corners;
};

/// The weights of control points in the places of a face, for each kind of surroundings that has occurred. They are
/// LocalLoop's. Safe from several threads.
class FacetStencils {
 public:
  /// Of each control point: the face's corners, those across its sides, then for each corner those onward but the first
  /// (and the last, where they close), and those back but the first. Padded.
  using Weights = std::vector<LocalValues>;
  /// Identifies a ring.
  using Key = std::array<std::uint32_t, 3>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  FacetStencils();
  /// False where so many triangles meet at a corner that the ring has no key.
  static bool find_key(const TriangleRing& ring, Key& key);
  /// The same for good.
  const Weights& at(const Key& key, const TriangleRing& ring);
  Weights made(const TriangleRing& ring) const;

  /// How the facets of any face lie: the one across a side, -1 at the face's own sides.
  struct Pattern {
    std::array<std::array<Index, 3>, kFacetsOfFace> corners;
    std::array<std::array<Index, 3>, kFacetsOfFace> across;
    std::array<std::array<int, 3>, kFacetsOfFace> side_of_face;
    std::array<std::array<int, 3>, kFacetsOfFace> place_on_side;
    std::array<std::array<Index, 4>, 3> along;  ///< the facets along each side of the face
  };
  const Pattern& pattern() const { return pattern_; }

 private:
  Pattern pattern_;
  std::mutex mutex_;
  std::unordered_map<Key, Weights, KeyHash> known_;
};

/// The facets of LocalLoop::refine() as they depend on some free control points. One thread uses an object, which keeps
/// its memory.
class LoopFacets {
 public:
  explicit LoopFacets(FacetStencils& stencils) : stencils_(stencils) {}
  /// places: one a vertex of the faces.
  void refine(const LocalFaces& control, std::span<const FreePlace> places);

  Index facet_count() const { return kFacetsOfFace * asked_; }
  /// The corners of a facet, as numbers of places(); those of two faces differ.
  std::array<Index, 3> facet(Index number) const {
    const Index first = kPlacesOfFace * (number / kFacetsOfFace);
    const std::array<Index, 3>& corners = stencils_.pattern().corners[static_cast<std::size_t>(number % kFacetsOfFace)];
    return {first + corners[0], first + corners[1], first + corners[2]};
  }
  /// kPlacesOfFace places a face.
  std::span<const FreePlace> places() const { return places_; }
  /// The facet across side i, which runs from corner i to the next; -1 where there is none.
  Index across(Index number, int side) const;
  bool is_sharp(Index number, int side) const;

 private:
  void walk(const LocalFaces& control, Index face, int corner);
  void name_columns(const LocalFaces& control, Index face);
  const FacetStencils::Weights& weights();
  void place(Index face, std::span<const FreePlace> places, const FacetStencils::Weights& weights);

  FacetStencils& stencils_;
  std::unordered_map<FacetStencils::Key, const FacetStencils::Weights*, FacetStencils::KeyHash> known_;
  FacetStencils::Weights rare_;
  Index asked_ = 0;
  std::vector<Index> twins_;
  std::vector<std::uint8_t> sharp_;
  std::vector<std::array<Index, 3>> ends_;
  TriangleRing ring_;
  std::array<std::vector<Index>, 3> onward_;  ///< the vertices of ring_
  std::array<std::vector<Index>, 3> back_;
  std::vector<Index> columns_;  ///< as Weights lists them, -1 where there is none
  std::vector<FreePlace> places_;
};

}  // namespace batten
