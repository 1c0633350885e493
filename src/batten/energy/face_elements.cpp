#include "batten/energy/face_elements.h"

#include <numeric>
#include <string>
#include <string_view>
#include <unordered_map>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/face_types.h"

namespace batten {

namespace {

constexpr std::ptrdiff_t kFaceBlock = 1024;

struct LayoutHash {
  std::size_t operator()(const PatchLayout& layout) const {
    return std::hash<std::string_view>()({reinterpret_cast<const char*>(layout.data()), layout.size()});
  }
};

/// Matrices of n^2 numbers are summed in O(n^3), which would take minutes beyond.
void require_small_rings(const SurfacePatches& patches) {
  constexpr Index kMostPoints = 512;
  const FaceTypes& faces = patches.face_types();
  for (Index f = 0; f < patches.base().face_count(); ++f) {
    if (faces.type(f) == RingTypes::kPatch) continue;
    const Index points = faces.ring_types().step(faces.type(f)).ring_size;
    if (points <= kMostPoints) continue;
    throw Error(ErrorCode::TooLarge, "face " + std::to_string(patches.control_face(f)) + " depends on " +
                                         std::to_string(points) + " points, and energies take at most " +
                                         std::to_string(kMostPoints) +
                                         "; cut the polygon, or the fan around the vertex, with so many sides");
  }
}

}  // namespace

PatchLayout layout_of(bool quads, const RegularPatch& patch) {
  PatchLayout layout{};
  std::int8_t count = 0;
  for (int i = 0; i < patch_size(quads); ++i) {
    if (patch.rows[i] == RegularPatch::kMissing) {
      layout[i] = static_cast<std::int8_t>(RegularPatch::kMissing);
      continue;
    }
    int first = 0;
    while (patch.rows[first] != patch.rows[i]) ++first;
    layout[i] = first < i ? layout[first] : count++;
  }
  return layout;
}

Buffer<Index> distinct_points(bool quads, const PatchLayout& layout) {
  Buffer<Index> points;
  for (int i = 0; i < patch_size(quads); ++i) {
    if (layout[i] == static_cast<std::int8_t>(points.size())) points.push_back(i);
  }
  return points;
}

Eigen::MatrixXd layout_points(bool quads, const PatchLayout& layout) {
  const int size = patch_size(quads);
  const auto count = static_cast<int>(distinct_points(quads, layout).size());
  std::array<Index, kQuadPatchSize> rows{};
  Values points = Values::Zero(size, count);
  for (int i = 0; i < size; ++i) {
    rows[i] = layout[i];
    if (layout[i] != static_cast<std::int8_t>(RegularPatch::kMissing)) points(i, rows[i]) = 1.0;
  }
  complete_patch(quads, rows.data(), points.data(), count);
  return points;
}

FaceElements::FaceElements(const SurfacePatches& patches)
    : ring_type_count_(patches.face_types().ring_types().type_count()) {
  require_small_rings(patches);
  const Buffer<std::uint8_t>& holes = patches.holes();
  for (Index f = 0; f < patches.base().face_count(); ++f) {
    if (!holes.empty() && holes[f] != 0) continue;
    base_faces_.push_back(f);
    faces_.push_back(patches.control_face(f));
  }
  number_kinds(patches);
}

/// Layouts get their numbers in the order of the faces, whatever thread found them.
void FaceElements::number_kinds(const SurfacePatches& patches) {
  const FaceTypes& types = patches.face_types();
  kinds_.resize(base_faces_.size());
  Buffer<PatchLayout> layouts(base_faces_.size());
  parallel_for(
      count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          kinds_[i] = types.type(base_faces_[i]);
          if (kinds_[i] == RingTypes::kPatch) layouts[i] = layout_of(patches.quads(), types.patch(base_faces_[i]));
        }
      },
      kFaceBlock);
  std::unordered_map<PatchLayout, Index, LayoutHash> numbers;
  for (Index i = 0; i < count(); ++i) {
    if (kinds_[i] != RingTypes::kPatch) continue;
    const auto [place, is_new] = numbers.try_emplace(layouts[i], kind_count());
    if (is_new) layouts_.push_back(layouts[i]);
    kinds_[i] = place->second;
  }
}

void FaceElements::list_vertices(const SurfacePatches& patches, const std::vector<Buffer<Index>>& points_of_kinds) {
  const FaceTypes& types = patches.face_types();
  starts_.assign(static_cast<std::size_t>(count()) + 1, 0);
  for (Index i = 0; i < count(); ++i) starts_[i + 1] = starts_[i] + points_of_kinds[kinds_[i]].size();
  vertices_.resize(starts_.back());
  parallel_for(
      count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        FaceRing scratch;
        for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i) {
          const Buffer<Index>& points = points_of_kinds[kinds_[i]];
          Index* const to = vertices_.data() + starts_[i];
          const Index face = base_faces_[i];
          if (types.type(face) == RingTypes::kPatch) {
            const RegularPatch patch = types.patch(face);
            for (std::size_t p = 0; p < points.size(); ++p) to[p] = patch.rows[points[p]];
          } else {
            const std::span<const Index> ring = types.ring(face, scratch);
            for (std::size_t p = 0; p < points.size(); ++p) to[p] = ring[points[p]];
          }
        }
      },
      kFaceBlock);
  list_uses(patches.base().vertex_count());
}

void FaceElements::list_uses(Index vertex_count) {
  first_uses_.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (const Index v : vertices_) ++first_uses_[v + 1];
  std::partial_sum(first_uses_.begin(), first_uses_.end(), first_uses_.begin());
  uses_.resize(vertices_.size());
  Buffer<std::size_t> next(first_uses_.begin(), first_uses_.end() - 1);
  for (Index i = 0; i < count(); ++i) {
    Index place = 0;
    for (const Index v : vertices(i)) uses_[next[v]++] = {i, place++};
  }
}

}  // namespace batten
