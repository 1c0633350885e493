/// \file How the surroundings of a face become those of its children: small matrices, once for all faces alike.
#pragma once
#include <array>
#include <string>
#include <unordered_map>
#include <vector>

#include "batten/patch/face_ring.h"
#include "batten/patch/regular_patch.h"
#include "batten/refine/sparse_rows.h"

namespace batten {

/// Types of one-rings and their children. A ring of a face has four children; each is a regular patch or a ring again,
/// for smooth extraordinary vertices, creases and corners the same one from some level on, so that the types are few.
/// Frames stay parallel: u of a child runs as u of the face; a triangle's middle child is turned by half.
class RingTypes {
 public:
  explicit RingTypes(const Scheme& scheme);

  struct Child {
    Index type;          ///< of ring, or kPatch
    SparseRows rows;     ///< of its ring or patch, on the ring of the face
    RegularPatch patch;  ///< of a patch: where rows stand; RegularPatch::kMissing ones follow by reflection
  };
  static constexpr Index kPatch = -1;

  /// The points of all four children at once: many are the same.
  struct Step {
    Index ring_size = 0;
    SparseRows rows;                        ///< on the ring of the face
    std::array<Buffer<Index>, 4> children;  ///< rows of each one's ring, or all 16 (12) of its patch
  };

  /// The type of a face's surroundings, which `ring` lists; works out its descendants where it is new. Not for faces
  /// with a regular patch.
  Index type_of(const Topology& topology, const FaceRing& ring);

  /// Quads: children at the corners in turn. Triangles: at the corners, then the middle.
  const Child& child(Index type, int number) const { return types_[type][number]; }
  Index type_count() const { return static_cast<Index>(types_.size()); }
  const Step& step(Index type) const { return steps_[type]; }

  /// Whether the face is at a pole (patch/poles.h).
  bool at_pole(Index type) const { return poles_[type].family >= 0; }
  /// Of a face at a pole: the type for which the first points of its ring, as many as that type's ring has, are enough
  /// for so many halvings. Other types are enough themselves.
  Index narrowed(Index type, int halvings) const;

 private:
  /// Rings that differ in how many faces at their pole they have are a family.
  struct PoleType {
    Index family = -1;
    int width = 0;
  };
  Index add_type(const FaceRing& ring);

  Scheme scheme_;
  std::unordered_map<std::string, Index> numbers_;
  std::vector<std::vector<Child>> types_;
  std::vector<Step> steps_;
  std::vector<PoleType> poles_;
  std::unordered_map<std::string, Index> family_numbers_;
  std::vector<Buffer<Index>> families_;  ///< the type of each width, or -1
};

}  // namespace batten
