#include "batten/io/face_sets.h"

#include <algorithm>
#include <map>

namespace batten::io {

std::vector<FaceSet> faces_by_material(const Mesh& mesh) {
  std::vector<FaceSet> sets;
  std::map<std::string, std::size_t> places;
  const auto add = [&](const std::string& name, Index first, Index last) {
    if (first == last) return;
    const auto place = places.emplace(name, sets.size());
    if (place.second) sets.push_back({name, {}});
    sets[place.first->second].ranges.emplace_back(first, last);
  };
  std::string name;
  Index first = 0;
  for (const Group& group : mesh.groups) {
    if (group.keyword != "usemtl") continue;
    add(name, first, group.first_face);
    name = group.name;
    first = group.first_face;
  }
  add(name, first, mesh.face_count());
  return sets;
}

}  // namespace batten::io
