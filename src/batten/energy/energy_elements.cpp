#include "batten/energy/energy_elements.h"

#include "batten/patch/face_types.h"

namespace batten {

EnergyElements::EnergyElements(const SurfacePatches& patches, std::optional<int> cutoff)
    : FaceElements(patches), energies_(ring_energies(patches.quads(), patches.face_types().ring_types(), cutoff)) {
  for (Index kind = static_cast<Index>(energies_.size()); kind < kind_count(); ++kind) {
    energies_.push_back(patch_energy(patches.quads(), layout(kind)));
  }
  std::vector<Buffer<Index>> points;
  for (const FaceEnergy& energy : energies_) points.push_back(energy.points);
  list_vertices(patches, points);
}

}  // namespace batten
