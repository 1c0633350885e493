#include "batten/patch/face_types.h"

#include <string>
#include <unordered_map>

#include "batten/patch/pieces.h"
#include "batten/patch/pole_keys.h"

namespace batten {

FaceTypes::FaceTypes(const Topology& base, const Scheme& base_scheme)
    : base_(base), scheme_(base_scheme), finder_(base, base_scheme), ring_types_(base_scheme), ring_starts_{0} {
  require_spline(base_scheme);
  const PoleKeys poles(base);
  std::unordered_map<std::string, Index> types_at_poles;
  std::string key;
  RegularPatch patch;
  FaceRing ring;
  for (Index f = 0; f < base.face_count(); ++f) {
    const Index side = base.face_begin(f);
    const bool regular = finder_.find(side, patch);
    const bool at_pole = !regular && poles.find(side, key);
    const auto known = at_pole ? types_at_poles.find(key) : types_at_poles.end();
    if (regular) {
      types_.push_back(RingTypes::kPatch);
    } else if (known != types_at_poles.end()) {
      types_.push_back(known->second);
    } else {
      ring.gather(base, scheme_, side);
      types_.push_back(ring_types_.type_of(base, ring));
      if (at_pole) {
        types_at_poles.emplace(key, types_.back());
      } else if (ring.vertices().size() <= kMostKeptRing) {
        rings_.insert(rings_.end(), ring.vertices().begin(), ring.vertices().end());
      }
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
