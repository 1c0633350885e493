/// \file The faces of a surface as finite elements: which are alike, and how each vertex finds its faces.
#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "batten/buffer.h"
#include "batten/patch/regular_patch.h"
#include "batten/patch/surface_patches.h"

namespace batten {

/// Which rows of a regular patch are missing (RegularPatch::kMissing) and which are the same vertex: each row has the
/// number of its vertex, in the order in which they come. Equal layouts have equal energies.
using PatchLayout = std::array<std::int8_t, kQuadPatchSize>;
PatchLayout layout_of(bool quads, const RegularPatch& patch);

/// The places in the patch where each vertex stands first.
Buffer<Index> distinct_points(bool quads, const PatchLayout& layout);

/// All points of the patch, a row each, by the distinct ones, a column each: what is missing follows by reflection.
Eigen::MatrixXd layout_points(bool quads, const PatchLayout& layout);

/// One element for each face of the base that is no hole, in the order of the faces. Const and safe from several
/// threads. Memory: 12 bytes for each point of an element, and 16 a face.
class FaceElements {
 public:
  /// O(faces). Throws Error(BadArgument) for the Butterflies, Error(TooLarge) where a face depends on more than 512
  /// points.
  explicit FaceElements(const SurfacePatches& patches);

  /// Elements of a kind have the same surroundings: the ring types come first, then the layouts of regular patches.
  Index kind_count() const { return ring_type_count_ + static_cast<Index>(layouts_.size()); }
  bool is_ring(Index kind) const { return kind < ring_type_count_; }
  const PatchLayout& layout(Index kind) const { return layouts_[kind - ring_type_count_]; }

  /// Tells which points elements of each kind depend on: places in the ring or, of a regular face, in the patch.
  /// Before that elements have no vertices. O(points of all elements).
  void list_vertices(const SurfacePatches& patches, const std::vector<Buffer<Index>>& points_of_kinds);

  /// An element that depends on a vertex, and the vertex's place among the element's.
  struct Use {
    Index element;
    Index place;
  };

  Index count() const { return static_cast<Index>(faces_.size()); }
  Index kind(Index element) const { return kinds_[element]; }
  Index base_face(Index element) const { return base_faces_[element]; }
  /// The control face that an element is, or lies in.
  Index control_face(Index element) const { return faces_[element]; }
  /// Vertices of the base, none twice.
  std::span<const Index> vertices(Index element) const {
    return std::span<const Index>(vertices_).subspan(starts_[element], starts_[element + 1] - starts_[element]);
  }
  /// Those of all elements, one after the other, and where an element's begin.
  std::span<const Index> vertices() const { return vertices_; }
  std::size_t start(Index element) const { return starts_[element]; }
  /// Elements in ascending order.
  std::span<const Use> uses(Index vertex) const {
    return std::span<const Use>(uses_).subspan(first_uses_[vertex], first_uses_[vertex + 1] - first_uses_[vertex]);
  }

 private:
  void number_kinds(const SurfacePatches& patches);
  void list_uses(Index vertex_count);

  Index ring_type_count_;
  std::vector<PatchLayout> layouts_;
  Buffer<Index> base_faces_;
  Buffer<Index> faces_;
  Buffer<Index> kinds_;
  Buffer<std::size_t> starts_;
  Buffer<Index> vertices_;
  Buffer<std::size_t> first_uses_;
  Buffer<Use> uses_;
};

}  // namespace batten
