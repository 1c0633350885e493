/// \file What a limit surface is made of, but for its control points: the one description that evaluation, weights,
/// nearest points, tessellation and energies share.
///
/// The base is the control mesh, or, for Catmull-Clark with faces that are no quads (or with alpha), its first
/// refinement, whose quad h belongs to corner h of the control mesh (refine/refinement.h). A base face is one piece
/// where it is regular; others are cut into pieces around what makes them irregular (patch/pieces.h). A piece is a
/// patch, which is a polynomial, or a ring, whose ring type says how its children follow (patch/ring_types.h).
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "batten/buffer.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

class FaceTypes;
class Pieces;
class RingTypes;
struct Piece;

/// Immutable and safe to share between threads. A handle as Topology is: copies share what they stand for, so that
/// several operators on one surface build it once. O(H) of time and memory, each part when it is first asked for.
class SurfacePatches {
 public:
  /// Throws Error(NotTriangles), Error(BadArgument) for alpha out of [0, 1], Error(TooLarge), Error(Cancelled).
  SurfacePatches(const Topology& topology, const Scheme& scheme, const Progress& progress = {});

  /// Of the control mesh, as given.
  const Topology& topology() const;
  const Scheme& scheme() const;

  /// What places refer to: all faces are quads or all are triangles.
  const Topology& base() const;
  const Scheme& base_scheme() const;
  bool has_first_step() const;
  bool quads() const { return scheme().kind == SchemeKind::CatmullClark; }
  /// Control points of a regular patch.
  int patch_size() const;

  /// The control face that a base face is, or lies in.
  Index control_face(Index base_face) const;
  /// One flag a base face that is no part of the surface (refine/refinement.h has the rules), or empty for none.
  const Buffer<std::uint8_t>& holes() const;

  /// Control values of the base. control: V-by-k. Throws Error(BadShape), Error(Cancelled).
  Values base_values(ConstValuesRef control, const Progress& progress = {}) const;
  /// A row of weights of the base's vertices as weights of control vertices, ascending.
  std::vector<std::pair<Index, double>> by_control(std::vector<std::pair<Index, double>> of_base) const;

  /// The base in pieces (patch/pieces.h), kRingPieceLevels deep. Throws Error(BadArgument) for the Butterflies,
  /// Error(TooLarge) where more than 1,024 faces meet at a vertex of a boundary or crease, or at a corner, whose
  /// sharpness is above kRingPieceLevels.
  const Pieces& pieces() const;
  /// The types of the pieces that are rings (patch/ring_types.h).
  const RingTypes& ring_types() const;
  Index ring_type(const Piece& piece) const;
  Index ring_type(std::int32_t shared_ring) const;

  /// The same for whole base faces (patch/face_types.h), which have more types. Throws the same errors, the
  /// second whatever the sharpness.
  const FaceTypes& face_types() const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

/// Throws Error(BadShape) unless control has a row of three numbers for each control vertex, Error(NotFinite).
void require_control_points(const Topology& topology, ConstValuesRef control);

}  // namespace batten
