/// \file The faces of a surface as finite elements with the matrices of their energies.
#pragma once
#include <optional>
#include <vector>

#include "batten/energy/face_elements.h"
#include "batten/energy/face_energies.h"

namespace batten {

/// Memory: that of FaceElements, next to a vertex of valence n some 2 n points an element, and the matrices of each
/// kind of face.
class EnergyElements : public FaceElements {
 public:
  /// cutoff as in ring_energies(). Throws Error(BadArgument) for the Butterflies, Error(TooLarge) where a face
  /// depends on more than 512 points.
  EnergyElements(const SurfacePatches& patches, std::optional<int> cutoff);

  const FaceEnergy& energy(Index element) const { return energies_[kind(element)]; }

 private:
  std::vector<FaceEnergy> energies_;  ///< of each kind
};

}  // namespace batten
