#include "batten/patch/face_types.h"

#include "batten/patch/pieces.h"

namespace batten {

FaceTypes::FaceTypes(const Topology& base, const Scheme& base_scheme)
    : base_(base), scheme_(base_scheme), finder_(base, base_scheme), ring_types_(base_scheme), ring_starts_{0} {
  require_spline(base_scheme);
  RegularPatch patch;
  FaceRing ring;
  for (Index f = 0; f < base.face_count(); ++f) {
    const Index side = base.face_begin(f);
    if (finder_.find(side, patch)) {
      types_.push_back(RingSteps::kPatch);
    } else {
      ring.gather(base, scheme_, side);
      if (ring.vertices().size() <= kMostKeptRing) {
        rings_.insert(rings_.end(), ring.vertices().begin(), ring.vertices().end());
      }
      types_.push_back(ring_types_.type_of(base, ring));
    }
    ring_starts_.push_back(rings_.size());
  }
}

std::span<const Index> FaceTypes::ring(Index face, FaceRing& scratch) const {
  if (ring_starts_[face] < ring_starts_[face + 1]) {
    return std::span<const Index>(rings_).subspan(ring_starts_[face], ring_starts_[face + 1] - ring_starts_[face]);
  }
  scratch.gather(base_, scheme_, base_.face_begin(face));
  return scratch.vertices();
}

RegularPatch FaceTypes::patch(Index face) const {
  RegularPatch patch;
  finder_.find(base_.face_begin(face), patch);
  return patch;
}

}  // namespace batten
