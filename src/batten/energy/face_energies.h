/// \file Energies of faces with the same surroundings: small matrices, once for all faces alike.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "batten/buffer.h"
#include "batten/energy/energy_kind.h"
#include "batten/energy/face_elements.h"
#include "batten/patch/regular_patch.h"
#include "batten/patch/ring_types.h"

namespace batten {

/// The matrices of a face, with coefficients 1, by the points that its surface depends on.
struct FaceEnergy {
  Buffer<Index> points;                     ///< places in the face's ring or, of a regular face, in its patch
  std::array<Eigen::MatrixXd, 3> matrices;  ///< Mass, Membrane, ThinPlate; symmetric to the last bit

  const Eigen::MatrixXd& matrix(EnergyKind kind) const { return matrices[static_cast<std::size_t>(kind)]; }
};

/// O(1).
FaceEnergy patch_energy(bool quads, const PatchLayout& layout);

/// The energies of all ring types. cutoff: empty for sums over all levels (energy/level_sums.h), or the number of
/// levels of a thin plate that count. Threaded. O(N^3 log levels) for each type of N points.
std::vector<FaceEnergy> ring_energies(bool quads, const RingTypes& types, std::optional<int> cutoff);

}  // namespace batten
