/// \file A surface cut into pieces that can be filled at once: faces between regular vertices as wholes, and around
/// whatever is irregular ever smaller ones (feature-adaptive refinement, after Niessner, Loop, Meyer and DeRose 2012,
/// key NLMD12).
///
/// Only irregular faces and their one-rings are refined, by Refinement: what the rules are is said there alone. Faces
/// whose surroundings occur often are not refined either: they share a ring, whose points are the same linear
/// combinations of its vertices everywhere.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "batten/patch/face_ring.h"
#include "batten/patch/regular_patch.h"
#include "batten/refine/refinement.h"

namespace batten {

/// The levels of pieces whose rest are rings: after so many, irregular faces are the ones around single vertices, whose
/// kinds are few.
inline constexpr int kRingPieceLevels = 2;

/// Rings of more vertices are gathered anew when they are asked for.
inline constexpr std::size_t kMostKeptRing = 1024;

/// A part of a face. Coordinates count steps of 1/2^levels of the face, u from its first corner along its first
/// half-edge. A turned piece (Loop) is the half turn of a triangle: its frame starts at (x, y) and runs backwards.
struct Piece {
  enum class Kind : std::uint8_t {
    Patch,  ///< rows: a RegularPatch
    Ring,   ///< the one-ring, as many points as the shared ring has
    Cell    ///< one step wide; rows: the corners
  };
  Index face;
  Index x;
  Index y;
  Index size;  ///< of the side, in steps
  Kind kind;
  bool turned;
  std::uint8_t level;        ///< of the values that the rows belong to
  std::int32_t shared_ring;  ///< of a ring
  Index half_edge;           ///< its first side in topology(level)
  std::size_t first_row;
};

/// The pieces of faces, for a uniform grid of 2^levels steps a side.
class Pieces {
 public:
  /// What becomes of faces that are irregular at the last level.
  enum class Rest {
    Cells,  ///< every face of the last level is a cell
    Rings   ///< rings, even where nothing shares them
  };

  /// Catmull-Clark: base faces are quads, and scheme.alpha is 0. O(H + pieces).
  Pieces(const Topology& base, const Scheme& scheme, int levels, Rest rest = Rest::Cells);
  /// Of one face only, without rings.
  Pieces(const Topology& base, const Scheme& scheme, int levels, Index face);

  int levels() const { return levels_; }
  const Scheme& scheme() const { return scheme_; }

  /// The pieces of a face: they tile it, and stand in an order that does not depend on threads.
  const Piece* begin(Index face) const { return pieces_.data() + first_piece_[face]; }
  const Piece* end(Index face) const { return pieces_.data() + first_piece_[face + 1]; }
  /// Of a patch or a cell.
  const Index* rows(const Piece& piece) const { return rows_.data() + piece.first_row; }
  /// The points of a ring (FaceRing::points). Those of large ones are gathered into `scratch`: around a vertex of
  /// valence n they would be n times 2 n numbers.
  std::span<const Index> ring(const Piece& piece, FaceRing& scratch) const;

  /// The surroundings that several pieces of one size share: its topology has the piece as face 0.
  struct SharedRing {
    Topology topology;
    Index size;
    Index points;  ///< of the ring
    Poles poles;   ///< of the topology: the face's corner, if it is one
  };
  const std::vector<SharedRing>& shared_rings() const { return shared_rings_; }

  /// Those of the last level, where its rest are rings.
  const Poles& poles() const { return poles_; }

  /// The refined neighbourhoods, coarse to fine: level l > 0 has the values refine() makes of those of level l - 1. The
  /// last level of rings also has the means of its poles (patch/poles.h).
  int region_count() const { return static_cast<int>(regions_.size()); }
  Values refine(int level, ConstValuesRef before) const;
  const Topology& topology(int level) const { return level == 0 ? base_ : regions_[level - 1]->step.child(); }

 private:
  /// Where a face of a region lies: its first corner, and the direction of its first half-edge in quarter (sixth)
  /// turns.
  struct Site {
    Index face;
    Index x;
    Index y;
    std::uint8_t turn;
  };
  class RingKeys;
  struct Region {
    Cutting cutting;
    Refinement step;
    Region(Cutting cutting_in, const Scheme& scheme) : cutting(std::move(cutting_in)), step(cutting.topology, scheme) {}
  };

  void build(Buffer<Index> faces, bool share);
  Buffer<std::uint8_t> take(int level, const Buffer<Index>& faces, const std::vector<Site>& sites, bool share);
  void append_taken(const Buffer<Piece>& found, const Buffer<std::uint8_t>& taken);
  void gather(const Topology& from, Index half_edge, FaceRing& ring) const;
  void share_rings(const Topology& from, std::size_t fewest, Buffer<Piece>& found, Buffer<std::uint8_t>& taken);
  std::vector<Site> child_sites(const std::vector<Site>& sites, Index size) const;
  Index aligned_corner(const Site& site, Index size, Piece& piece) const;
  void sort_pieces();

  Topology base_;
  Scheme scheme_;
  int levels_;
  Rest rest_;
  Poles poles_;
  Buffer<std::size_t> first_piece_;
  Buffer<Piece> pieces_;
  Buffer<Index> rows_;
  std::vector<SharedRing> shared_rings_;
  std::vector<std::unique_ptr<Region>> regions_;
};

/// Throws Error(BadArgument) for the Butterflies, whose surfaces have no closed form between the vertices.
void require_spline(const Scheme& scheme);

/// True where pieces need the first refinement for a base: Catmull-Clark on other faces than quads, or with alpha.
bool needs_first_step(const Topology& topology, const Scheme& scheme);

}  // namespace batten
