#include "batten/mesh/repeated_faces.h"

#include <algorithm>

#include "batten/mixed_bits.h"

namespace batten {

namespace {

enum class Match { None, SameDirection, Reversed };

/// Compares the cycles of vertices of two faces.
Match compare(const Index* a, const Index* b, Index size) {
  const auto start = static_cast<Index>(std::find(b, b + size, a[0]) - b);
  if (start == size) return Match::None;
  bool same = true;
  bool opposite = true;
  for (Index i = 0; i < size; ++i) {
    same = same && a[i] == b[(start + i) % size];
    opposite = opposite && a[i] == b[(start + size - i) % size];
  }
  if (same) return Match::SameDirection;
  return opposite ? Match::Reversed : Match::None;
}

/// Sums of these over a face's vertices differ.
std::uint64_t mixed(std::uint64_t x) { return mixed_bits(x + 0x9e3779b97f4a7c15U); }

struct Keyed {
  std::uint64_t key;
  Index size;
  Index face;
  bool like(const Keyed& other) const { return key == other.key && size == other.size; }
  bool operator<(const Keyed& other) const {
    if (key != other.key) return key < other.key;
    return size != other.size ? size < other.size : face < other.face;
  }
};

}  // namespace

void for_each_repeated_face(const Buffer<Index>& offsets, const Buffer<Index>& names,
                            const Buffer<std::uint8_t>& skipped, const std::function<void(Index, Index, bool)>& visit) {
  Buffer<Keyed> faces;
  for (Index f = 0; f + 1 < static_cast<Index>(offsets.size()); ++f) {
    if (!skipped.empty() && skipped[f] != 0) continue;
    std::uint64_t key = 0;
    for (Index c = offsets[f]; c < offsets[f + 1]; ++c) key += mixed(static_cast<std::uint64_t>(names[c]));
    faces.push_back({key, offsets[f + 1] - offsets[f], f});
  }
  std::sort(faces.begin(), faces.end());
  std::vector<Index> firsts;  // the different faces with one key; almost always one
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i == 0 || !faces[i].like(faces[i - 1])) firsts.clear();
    Match match = Match::None;
    for (const Index first : firsts) {
      match = compare(&names[offsets[first]], &names[offsets[faces[i].face]], faces[i].size);
      if (match == Match::None) continue;
      visit(first, faces[i].face, match == Match::SameDirection);
      break;
    }
    if (match == Match::None) firsts.push_back(faces[i].face);
  }
}

}  // namespace batten
