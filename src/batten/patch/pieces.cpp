#include "batten/patch/pieces.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/quad_ring.h"

namespace batten {

namespace {

constexpr int kQuadTurns[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
constexpr int kTriangleTurns[6][2] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};

/// A ring's table costs about as much as refining so many faces.
constexpr std::size_t kFewestSharing = 16;
/// Tables for larger rings would take more memory than they save time.
constexpr std::size_t kMostRingVertices = 64;
/// Instead of a place among the rows: a large ring.
constexpr auto kGathered = static_cast<std::size_t>(-1);

/// The faces, then those that share a vertex with one of them.
Buffer<Index> with_one_ring(const Topology& topology, const Buffer<Index>& faces) {
  Buffer<std::uint8_t> taken(static_cast<std::size_t>(topology.face_count()), 0);
  Buffer<std::uint8_t> met(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (const Index f : faces) taken[f] = 1;
  Buffer<Index> all;
  all.reserve(2 * faces.size());
  all = faces;
  for (const Index f : faces) {
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
      const Index v = topology.origin(h);
      if (met[v] != 0) continue;
      met[v] = 1;
      topology.for_each_outgoing(v, [&](Index out) {
        const Index neighbour = topology.face(out);
        if (taken[neighbour] != 0) return;
        taken[neighbour] = 1;
        all.push_back(neighbour);
      });
    }
  }
  return all;
}

/// First half-edges of the faces, then of all that have a say in how their one-rings refine: the one-ring, and under
/// Chaikin's rule, which looks at both ends of an edge, the second ring.
Buffer<Index> with_surroundings(const Topology& topology, const Scheme& scheme, const Buffer<Index>& faces) {
  Buffer<Index> all = with_one_ring(topology, faces);
  if (scheme.crease_method == CreaseMethod::Chaikin && topology.has_creases()) all = with_one_ring(topology, all);
  for (Index& face : all) face = topology.face_begin(face);
  return all;
}

/// The places in `from` of the numbers of `to`.
Buffer<std::uint8_t> places_of(const Buffer<Index>& to, std::span<const Index> from) {
  Buffer<std::uint8_t> places;
  for (const Index number : to) {
    places.push_back(static_cast<std::uint8_t>(std::find(from.begin(), from.end(), number) - from.begin()));
  }
  return places;
}

}  // namespace

void require_spline(const Scheme& scheme) {
  if (!is_interpolating(scheme.kind)) return;
  throw Error(ErrorCode::BadArgument, std::string(scheme_name(scheme.kind)) +
                                          " surfaces are no splines: there is no closed form between their vertices, "
                                          "and no curvature; refine them, or take Loop");
}

Pieces::Pieces(const Topology& base, const Scheme& scheme, int levels, Rest rest)
    : base_(base), scheme_(scheme), levels_(levels), rest_(rest) {
  require_spline(scheme);
  Buffer<Index> faces(static_cast<std::size_t>(base.face_count()));
  std::iota(faces.begin(), faces.end(), 0);
  build(std::move(faces), true);
}

Pieces::Pieces(const Topology& base, const Scheme& scheme, int levels, Index face)
    : base_(base), scheme_(scheme), levels_(levels), rest_(Rest::Cells) {
  require_spline(scheme);
  build({face}, false);
}

void Pieces::build(Buffer<Index> faces, bool share) {
  std::vector<Site> sites;
  sites.reserve(faces.size());
  for (const Index f : faces) sites.push_back({f, 0, 0, 0});
  for (int level = 0; !faces.empty(); ++level) {
    const Buffer<std::uint8_t> taken = take(level, faces, sites, share);
    Buffer<Index> rest;
    std::vector<Site> rest_sites;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (taken[i] != 0) continue;
      rest.push_back(faces[i]);
      rest_sites.push_back(sites[i]);
    }
    if (rest.empty()) break;
    const Topology& from = topology(level);
    regions_.push_back(std::make_unique<Region>(cut_out(from, with_surroundings(from, scheme_, rest)), scheme_));
    sites = child_sites(rest_sites, Index{1} << (levels_ - level - 1));
    faces.resize(sites.size());  // the children of the first faces are the first children
    std::iota(faces.begin(), faces.end(), 0);
  }
  sort_pieces();
}

/// The corner of a site from which the piece's frame starts; sets where it stands.
Index Pieces::aligned_corner(const Site& site, Index size, Piece& piece) const {
  piece.face = site.face;
  piece.size = size;
  piece.turned = false;
  if (scheme_.kind == SchemeKind::CatmullClark) {
    const Index corner = (4 - site.turn) % 4;
    const int* u = kQuadTurns[site.turn];
    const int* v = kQuadTurns[(site.turn + 1) % 4];
    piece.x = site.x + size * ((corner == 1 || corner == 2 ? u[0] : 0) + (corner >= 2 ? v[0] : 0));
    piece.y = site.y + size * ((corner == 1 || corner == 2 ? u[1] : 0) + (corner >= 2 ? v[1] : 0));
    return corner;
  }
  // From corner c the first half-edge runs in direction turn + 2 c: 0 upright, 3 turned.
  piece.turned = site.turn % 2 == 1;
  Index corner = 0;
  while ((site.turn + 2 * corner) % 6 != (piece.turned ? 3 : 0)) ++corner;
  const int* u = kTriangleTurns[(site.turn + (corner == 2 ? 1 : 0)) % 6];
  piece.x = site.x + (corner == 0 ? 0 : size * u[0]);
  piece.y = site.y + (corner == 0 ? 0 : size * u[1]);
  return corner;
}

/// Makes pieces of what needs no more refinement: regular faces, cells, and with `share` frequent rings.
/// Returns one flag a face.
Buffer<std::uint8_t> Pieces::take(int level, const Buffer<Index>& faces, const std::vector<Site>& sites, bool share) {
  const Topology& from = topology(level);
  const bool last = level == levels_;
  const bool cells = last && rest_ == Rest::Cells;
  const Index corners = scheme_.kind == SchemeKind::Loop ? 3 : 4;
  const std::size_t patch_size = scheme_.kind == SchemeKind::Loop ? kTrianglePatchSize : kQuadPatchSize;
  const std::size_t row_count = cells ? static_cast<std::size_t>(corners) : patch_size;
  const std::size_t first_row = rows_.size();
  rows_.resize(first_row + row_count * faces.size());
  const auto finder = cells ? nullptr : std::make_unique<PatchFinder>(from, scheme_);
  Buffer<Piece> found(faces.size());
  Buffer<std::uint8_t> taken(faces.size());
  parallel_for(static_cast<std::ptrdiff_t>(faces.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    RegularPatch patch;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      Piece& piece = found[i];
      const Index first = from.face_begin(faces[i]);
      const Index corner = aligned_corner(sites[i], Index{1} << (levels_ - level), piece);
      piece.level = static_cast<std::uint8_t>(level);
      piece.half_edge = first + corner;
      piece.shared_ring = -1;
      piece.first_row = first_row + row_count * static_cast<std::size_t>(i);
      Index* rows = rows_.data() + piece.first_row;
      taken[i] = 1;
      if (cells) {
        piece.kind = Piece::Kind::Cell;
        for (Index c = 0; c < corners; ++c) rows[c] = from.origin(first + (corner + c) % corners);
      } else if (finder->find(piece.half_edge, patch)) {
        piece.kind = Piece::Kind::Patch;
        std::copy_n(patch.rows.begin(), row_count, rows);
      } else {
        piece.kind = Piece::Kind::Ring;
        taken[i] = 0;
      }
    }
  });
  if (last && !cells) poles_ = Poles(from, scheme_);
  if (share) share_rings(from, last && !cells ? 1 : kFewestSharing, found, taken);
  append_taken(found, taken);
  return taken;
}

void Pieces::append_taken(const Buffer<Piece>& found, const Buffer<std::uint8_t>& taken) {
  const auto count = static_cast<std::ptrdiff_t>(found.size());
  Buffer<std::size_t> starts(static_cast<std::size_t>(block_count(count)) + 1, pieces_.size());
  parallel_for(count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    starts[begin / kDefaultBlock + 1] =
        static_cast<std::size_t>(std::count(&taken[begin], &taken[begin] + (end - begin), 1));
  });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  pieces_.resize(starts.back());
  parallel_for(count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::size_t next = starts[begin / kDefaultBlock];
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      if (taken[i] != 0) pieces_[next++] = found[i];
    }
  });
}

/// The keys and vertices of many one-rings, gathered by threads into blocks of their own.
class Pieces::RingKeys {
 public:
  RingKeys(const Topology& from, const Scheme& scheme, const Poles& poles, const Buffer<Piece>& found,
           const Buffer<std::size_t>& which, std::size_t most)
      : entries_(which.size()), blocks_(static_cast<std::size_t>(block_count(count(), kBlock))) {
    const SharpnessCodes codes(from);
    parallel_for(
        count(),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          QuadRing quads(from, scheme, codes);
          FaceRing ring;
          Block& block = blocks_[begin / kBlock];
          for (std::ptrdiff_t i = begin; i < end; ++i) {
            const Index half_edge = found[which[i]].half_edge;
            if (quads.gather(half_edge)) {
              const char* const code = reinterpret_cast<const char*>(quads.code().data());
              add(i, true, {code, sizeof(QuadRing::Code)}, quads, block);
              continue;
            }
            if (most < FaceRing::kAnyNumber) {
              if (!ring.gather(from, scheme, half_edge, most)) continue;
            } else {
              ring.gather(from, scheme, half_edge, poles, Poles::kWidth);
            }
            add(i, false, ring.key(), ring.points().size() > kMostKeptRing ? Buffer<Index>() : ring.points(), block);
          }
        },
        kBlock);
  }

  std::ptrdiff_t count() const { return static_cast<std::ptrdiff_t>(entries_.size()); }
  /// Empty where the ring was too large. A FaceRing's has more bytes than a QuadRing's.
  std::string_view key(std::ptrdiff_t i) const {
    return {blocks_[i / kBlock].keys.data() + entries_[i].key_start, entries_[i].key_size};
  }
  std::size_t hash(std::ptrdiff_t i) const { return entries_[i].hash; }
  /// In the order of QuadRing, or else of FaceRing; empty for large rings.
  std::span<const Index> rows(std::ptrdiff_t i) const {
    return std::span<const Index>(blocks_[i / kBlock].rows).subspan(entries_[i].row_start, entries_[i].row_count);
  }
  bool is_quad_ring(std::ptrdiff_t i) const { return entries_[i].quad; }

 private:
  static constexpr std::ptrdiff_t kBlock = 512;
  struct Block {
    Buffer<char> keys;
    Buffer<Index> rows;
  };
  struct Entry {
    std::size_t key_start = 0;
    std::size_t row_start = 0;
    std::size_t hash = 0;
    std::uint32_t key_size = 0;
    std::uint32_t row_count = 0;
    bool quad = false;
  };

  template <typename Rows>
  void add(std::ptrdiff_t i, bool quad, std::string_view key, const Rows& rows, Block& block) {
    entries_[i] = {block.keys.size(),
                   block.rows.size(),
                   std::hash<std::string_view>()(key),
                   static_cast<std::uint32_t>(key.size()),
                   static_cast<std::uint32_t>(rows.end() - rows.begin()),
                   quad};
    block.keys.insert(block.keys.end(), key.begin(), key.end());
    block.rows.insert(block.rows.end(), rows.begin(), rows.end());
  }

  Buffer<Entry> entries_;
  std::vector<Block> blocks_;
};

void Pieces::gather(const Topology& from, Index half_edge, FaceRing& ring) const {
  ring.gather(from, scheme_, half_edge, poles_, Poles::kWidth);
}

/// Takes the irregular faces whose surroundings occur at least `fewest` times.
void Pieces::share_rings(const Topology& from, std::size_t fewest, Buffer<Piece>& found, Buffer<std::uint8_t>& taken) {
  Buffer<std::size_t> irregular;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (taken[i] == 0) irregular.push_back(i);
  }
  const RingKeys rings(from, scheme_, poles_, found, irregular, fewest > 1 ? kMostRingVertices : FaceRing::kAnyNumber);
  struct Sharing {
    std::size_t count = 0;
    std::int32_t number = -1;
    Buffer<std::uint8_t> order;  ///< of a QuadRing's vertices, as the shared ring has them
  };
  // Equal surroundings go by the number of the first ring that has them.
  const auto hash = [&](std::ptrdiff_t i) { return rings.hash(i); };
  const auto equal = [&](std::ptrdiff_t a, std::ptrdiff_t b) { return rings.key(a) == rings.key(b); };
  std::unordered_map<std::ptrdiff_t, Sharing, decltype(hash), decltype(equal)> sharings(256, hash, equal);
  std::vector<Sharing*> sharing_of(irregular.size());
  for (std::ptrdiff_t i = 0; i < rings.count(); ++i) {
    if (rings.key(i).empty()) continue;
    sharing_of[i] = &sharings[i];
    ++sharing_of[i]->count;
  }
  for (std::ptrdiff_t i = 0; i < rings.count(); ++i) {
    Sharing* sharing = sharing_of[i];
    if (sharing == nullptr || sharing->count < fewest) continue;
    Piece& piece = found[irregular[i]];
    const std::span<const Index> rows = rings.rows(i);
    if (sharing->number < 0) {
      sharing->number = static_cast<std::int32_t>(shared_rings_.size());
      FaceRing ring;
      gather(from, piece.half_edge, ring);
      if (rings.is_quad_ring(i)) sharing->order = places_of(ring.vertices(), rows);
      const Topology cut = cut_out(from, ring.half_edges()).topology;
      const Poles poles = ring.pole_corner() < 0 ? Poles() : Poles(cut, ring.pole_corner(), ring.pole_faces());
      shared_rings_.push_back({cut, piece.size, static_cast<Index>(ring.points().size()), poles});
    }
    piece.shared_ring = sharing->number;
    taken[irregular[i]] = 1;
    if (rows.empty()) {
      piece.first_row = kGathered;
      continue;
    }
    piece.first_row = rows_.size();
    rows_.resize(piece.first_row + rows.size());
    Index* const to = rows_.data() + piece.first_row;
    if (rings.is_quad_ring(i)) {
      for (std::size_t k = 0; k < rows.size(); ++k) to[k] = rows[sharing->order[k]];
    } else {
      std::copy(rows.begin(), rows.end(), to);
    }
  }
}

std::vector<Pieces::Site> Pieces::child_sites(const std::vector<Site>& sites, Index size) const {
  const bool quads = scheme_.kind == SchemeKind::CatmullClark;
  const int turns = quads ? 4 : 6;
  const auto direction = [&](int turn) { return quads ? kQuadTurns[turn % turns] : kTriangleTurns[turn % turns]; };
  std::vector<Site> children;
  children.reserve(4 * sites.size());
  for (const Site& site : sites) {
    Site corner = site;
    for (int c = 0; c < (quads ? 4 : 3); ++c) {
      corner.turn = static_cast<std::uint8_t>((site.turn + (quads ? c : 2 * c)) % turns);
      children.push_back(corner);
      corner.x += 2 * size * direction(corner.turn)[0];
      corner.y += 2 * size * direction(corner.turn)[1];
    }
    if (quads) continue;
    const int* u = direction(site.turn);
    children.push_back(
        {site.face, site.x + size * u[0], site.y + size * u[1], static_cast<std::uint8_t>((site.turn + 1) % turns)});
  }
  return children;
}

/// Face by face, each face's pieces in the order they were found.
void Pieces::sort_pieces() {
  first_piece_.assign(static_cast<std::size_t>(base_.face_count()) + 1, 0);
  const auto by_face = [](const Piece& a, const Piece& b) { return a.face < b.face; };
  for (const Piece& piece : pieces_) ++first_piece_[static_cast<std::size_t>(piece.face) + 1];
  std::partial_sum(first_piece_.begin(), first_piece_.end(), first_piece_.begin());
  if (std::is_sorted(pieces_.begin(), pieces_.end(), by_face)) return;
  Buffer<std::size_t> next(first_piece_.begin(), first_piece_.end() - 1);
  Buffer<Piece> sorted(pieces_.size());
  for (const Piece& piece : pieces_) sorted[next[piece.face]++] = piece;
  pieces_ = std::move(sorted);
}

std::span<const Index> Pieces::ring(const Piece& piece, FaceRing& scratch) const {
  if (piece.first_row != kGathered) {
    const Index count = shared_rings_[piece.shared_ring].points;
    return {rows_.data() + piece.first_row, static_cast<std::size_t>(count)};
  }
  gather(topology(piece.level), piece.half_edge, scratch);
  return scratch.points();
}

bool needs_first_step(const Topology& topology, const Scheme& scheme) {
  return scheme.kind == SchemeKind::CatmullClark && (topology.uniform_face_size() != 4 || scheme.alpha > 0.0);
}

Values Pieces::refine(int level, ConstValuesRef before) const {
  const Region& region = *regions_[level - 1];
  const Buffer<Index>& rows = region.cutting.rows;
  Values values(static_cast<std::ptrdiff_t>(rows.size()), before.cols());
  parallel_for(values.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) values.row(i) = before.row(rows[i]);
  });
  Values refined = region.step.apply(values);
  return level == levels_ && !poles_.empty() ? poles_.with_means(region.step.child(), refined) : refined;
}

}  // namespace batten
