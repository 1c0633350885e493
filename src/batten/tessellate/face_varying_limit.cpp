#include "batten/tessellate/face_varying_limit.h"

#include <algorithm>
#include <span>
#include <utility>

#include "batten/limit/limit_matrix.h"
#include "batten/patch/surface_patches.h"
#include "batten/refine/face_varying.h"
#include "batten/tessellate/tessellator.h"

namespace batten {

namespace {

Attribute at_own_faces(FaceVaryingSurface surface, const std::string& name) {
  surface.values = LimitMatrix(surface.topology, surface.scheme).apply(surface.values);
  Attribute all = surface.attribute(name);
  if (!surface.topology.has_holes()) return all;
  Buffer<Index> drawn;
  for (Index h = 0; h < surface.topology.half_edge_count(); ++h) {
    if (!surface.topology.is_hole(surface.topology.face(h))) drawn.push_back(all.corner_rows[h]);
  }
  all.corner_rows = std::move(drawn);
  return all;
}

/// Takes the rows of the faces that have no values away.
void clear_rows(const SurfacePatches& patches, const Buffer<std::uint8_t>& without_values, std::size_t per_face,
                Buffer<Index>& rows) {
  auto face_rows = rows.begin();
  for (Index f = 0; f < patches.base().face_count(); ++f) {
    if (!patches.holes().empty() && patches.holes()[f] != 0) continue;
    const auto end = face_rows + static_cast<std::ptrdiff_t>(per_face);
    if (without_values[patches.control_face(f)] != 0) std::fill(face_rows, end, -1);
    face_rows = end;
  }
}

}  // namespace

Attribute face_varying_limit(const Topology& topology, const Scheme& scheme, const Attribute& attribute, int levels,
                             const Progress& progress) {
  FaceVaryingSurface surface = face_varying_surface(topology, scheme, attribute);
  if (levels == 0) return at_own_faces(std::move(surface), attribute.name);
  constexpr double kBuilt = 0.3;  // of the time
  const SurfacePatches patches(surface.topology, surface.scheme, progress_within(progress, 0.0, kBuilt));
  const Tessellator tessellator(patches, levels);
  Attribute limit{attribute.name, Values(tessellator.vertex_count(), attribute.values.cols()), {}};
  tessellator.limit<double>(surface.values,
                            std::span(limit.values.data(), static_cast<std::size_t>(limit.values.size())), {},
                            progress_within(progress, kBuilt, 1.0));
  const auto face_size = static_cast<std::size_t>(tessellator.face_size());
  limit.corner_rows.resize(static_cast<std::size_t>(tessellator.face_count()) * face_size);
  tessellator.faces(limit.corner_rows);
  if (!surface.without_values.empty()) {
    const auto steps = static_cast<std::size_t>(tessellator.steps());
    clear_rows(patches, surface.without_values, steps * steps * face_size, limit.corner_rows);
  }
  return limit;
}

}  // namespace batten
