/// \file The limit surface of Loop's scheme over a few triangles, as facets.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "batten/types.h"

namespace batten {

/// A triangle of the control mesh becomes so many facets.
inline constexpr int kFacetsOfFace = 16;

/// Numbers of a vertex, each refined by itself.
using LocalValues = std::array<double, 16>;

/// Part of a triangle mesh: the first `asked` faces are those whose surface is wanted; all others that touch their
/// vertices follow. Half-edge 3 f + i runs from corner i of face f to the next.
struct LocalFaces {
  std::vector<std::array<Index, 3>> faces;
  std::vector<std::uint8_t> sharp;  ///< one flag a half-edge; the same for both of an edge
  Index asked = 0;
};

inline Index next_in_face(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline Index last_in_face(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// The half-edge across each one, -1 where there is none, by sorting in `work`.
void find_twins(const std::vector<std::array<Index, 3>>& faces, std::vector<Index>& twins,
                std::vector<std::array<Index, 3>>& work);

/// Two steps of refinement and the limit positions of the corners: kFacetsOfFace facets a face, whose numbers do not
/// depend on what is around it. Sharp edges and boundaries follow the rules of infinite sharpness. An object keeps its
/// memory from one call to the next. A vertex without faces stays.
class LocalLoop {
 public:
  LocalLoop();
  /// values: of each vertex of the faces.
  void refine(const LocalFaces& control, std::span<const LocalValues> values);

  Index facet_count() const { return kFacetsOfFace * asked_; }
  /// The corners of a facet, as numbers of limits().
  const std::array<Index, 3>& facet(Index number) const { return fine_.faces[static_cast<std::size_t>(number)]; }
  /// Of all vertices of the facets.
  std::span<const LocalValues> limits() const { return limits_; }
  /// The facet across side i, which runs from corner i to the next; -1 where there is none.
  Index across(Index number, int side) const {
    const Index twin = fine_.twins[3 * static_cast<std::size_t>(number) + side];
    return twin < 0 || twin / 3 >= facet_count() ? -1 : twin / 3;
  }
  bool is_sharp(Index number, int side) const { return fine_.sharp[3 * static_cast<std::size_t>(number) + side] != 0; }

 private:
  struct Level {
    std::vector<std::array<Index, 3>> faces;
    std::vector<Index> twins;
    std::vector<std::uint8_t> sharp;
    std::vector<Index> outgoing;  ///< a half-edge of each vertex
    std::vector<LocalValues> values;
  };
  struct Ring;
  Ring ring_of(const Level& level, Index vertex) const;
  LocalValues moved_vertex(const Level& level, Index vertex, bool limit) const;
  void refine_level(const Level& from, Level& to);
  void keep_near(Level& level, std::size_t wanted);
  void find_limits();

  static constexpr int kMostValence = 64;
  std::array<double, kMostValence + 1> vertex_weights_{};  ///< of a vertex in its child
  std::array<double, kMostValence + 1> limit_weights_{};   ///< of a vertex in its limit
  Index asked_ = 0;
  Level control_;
  Level middle_;
  Level fine_;
  std::vector<LocalValues> limits_;
  std::vector<Index> edges_;
  std::vector<std::array<Index, 3>> ends_;
  std::vector<std::uint8_t> done_;
  std::vector<Index> number_;
};

}  // namespace batten
