/// Repeated faces: the first is kept.
#include <algorithm>

#include "batten/mesh/repair_draft.h"
#include "batten/mesh/repeated_faces.h"

namespace batten {

namespace {

/// True if two faces of opposite directions may both be kept.
bool both_stay(const Draft& draft, const SideTable& sides, const Buffer<std::uint8_t>& doubled, Index face) {
  bool pillow = true;
  bool wall = true;
  for (Index c = draft.offsets[face]; c < draft.offsets[face + 1]; ++c) {
    const SideTable::Side wanted{SideTable::edge_key(sides.from(c), sides.to(c)), -1};
    auto side = std::lower_bound(sides.sorted().begin(), sides.sorted().end(), wanted);
    int others = 0;
    int single = 0;
    for (; side != sides.sorted().end() && side->edge == wanted.edge; ++side) {
      ++others;
      single += doubled[sides.face(side->corner)] == 0 ? 1 : 0;
    }
    pillow = pillow && others == 2;
    wall = wall && single == 2;
  }
  return pillow || wall;
}

}  // namespace

void drop_repeated_faces(Draft& draft, RepairLog& log) {
  const auto count = static_cast<std::size_t>(draft.face_count());
  Buffer<std::uint8_t> dropped(count, 0);
  Buffer<std::uint8_t> doubled(count, 0);
  std::vector<std::pair<Index, Index>> opposite;
  bool any = false;
  for_each_repeated_face(draft.offsets, draft.vertices, {}, [&](Index first, Index later, bool same_direction) {
    any = true;
    if (same_direction || doubled[first] != 0) {
      dropped[later] = 1;
    } else {
      doubled[first] = doubled[later] = 1;
      opposite.emplace_back(first, later);
    }
  });
  if (!any) return;
  if (!opposite.empty()) {
    const SideTable sides(draft.offsets, draft.vertices, dropped);
    for (const auto& pair : opposite) {
      if (!both_stay(draft, sides, doubled, pair.first)) dropped[pair.second] = 1;
    }
  }
  for (Index f = 0; f < draft.face_count(); ++f) {
    if (dropped[f] != 0) log.add(RepairKind::RepeatedFaces, draft.face_sources[f]);
  }
  draft.drop_faces(dropped);
}

}  // namespace batten
