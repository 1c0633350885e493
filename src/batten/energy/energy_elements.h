/// \file The faces of a surface as finite elements: what they depend on, and how each vertex finds its faces.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "batten/energy/face_energies.h"
#include "batten/patch/surface_patches.h"

namespace batten {

/// One element for each face of the base that is no hole, in the order of the faces. Const and safe from several
/// threads. Memory: 12 bytes for each point of an element, 16 on a regular face, and the matrices of each kind of face;
/// next to a vertex of valence n some 2 n points.
class EnergyElements {
 public:
  /// cutoff as in ring_energies(). Throws Error(BadArgument) for the Butterflies, Error(TooLarge) where a face
  /// depends on more than 512 points.
  EnergyElements(const SurfacePatches& patches, std::optional<int> cutoff);

  /// An element that depends on a vertex, and the vertex's place among the element's.
  struct Use {
    Index element;
    Index place;
  };

  Index count() const { return static_cast<Index>(faces_.size()); }
  /// The control face that an element is, or lies in.
  Index control_face(Index element) const { return faces_[element]; }
  /// Vertices of the base, none twice.
  std::span<const Index> vertices(Index element) const {
    return std::span<const Index>(vertices_).subspan(starts_[element], starts_[element + 1] - starts_[element]);
  }
  const FaceEnergy& energy(Index element) const { return energies_[kinds_[element]]; }
  /// Elements in ascending order.
  std::span<const Use> uses(Index vertex) const {
    return std::span<const Use>(uses_).subspan(first_uses_[vertex], first_uses_[vertex + 1] - first_uses_[vertex]);
  }

 private:
  void number_kinds(const SurfacePatches& patches);
  void list_vertices(const SurfacePatches& patches);
  void list_uses(Index vertex_count);

  std::vector<FaceEnergy> energies_;  ///< of the ring types, then of the layouts of regular patches
  Buffer<Index> base_faces_;
  Buffer<Index> faces_;
  Buffer<Index> kinds_;
  Buffer<std::size_t> starts_;
  Buffer<Index> vertices_;
  Buffer<std::size_t> first_uses_;
  Buffer<Use> uses_;
};

}  // namespace batten
