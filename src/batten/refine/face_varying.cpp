#include "batten/refine/face_varying.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/refine/refinement.h"
#include "batten/refine/vertex_blend.h"
#include "batten/scheme/sharpness.h"

namespace batten {

namespace {

/// The faces at a vertex between one seam or boundary and the next, which have one value there.
struct Sector {
  Index start;        ///< the first half-edge, which leaves the vertex
  std::size_t place;  ///< of this half-edge among those that leave the vertex
  Index row;          ///< -1: faces without values
  Index faces = 0;
  bool open = true;           ///< false where it goes all around the vertex
  bool repeated = false;      ///< another sector of the vertex has the same row
  std::size_t first = 0;      ///< the first that has it
  bool divided = false;       ///< an infinitely sharp edge lies inside
  Buffer<float> fading = {};  ///< the semi-sharp edges inside
};

/// The one sharpness that fades when the last of several does, with the same weight.
float last_to_fade(const Buffer<float>& sharpness) {
  float levels = 0.0F;
  float sum = 0.0F;
  int count = 0;
  for (const float one : sharpness) {
    const float own = std::ceil(one);
    if (own < levels) continue;
    if (own > levels) {
      levels = own;
      sum = 0.0F;
      count = 0;
    }
    sum += one;
    ++count;
  }
  return sum / static_cast<float>(count);
}

/// The row numbers, but none at all on faces where one is missing.
Buffer<Index> checked_rows(const Topology& topology, const Attribute& attribute) {
  if (static_cast<Index>(attribute.corner_rows.size()) != topology.half_edge_count()) {
    throw Error(ErrorCode::BadShape, "attribute '" + attribute.name + "' must have one row number per corner");
  }
  Buffer<Index> rows = attribute.corner_rows;
  for (Index f = 0; f < topology.face_count(); ++f) {
    const auto begin = rows.begin() + topology.face_begin(f);
    const auto end = rows.begin() + topology.face_end(f);
    for (auto row = begin; row != end; ++row) {
      if (*row < static_cast<Index>(attribute.values.rows())) continue;
      throw Error(ErrorCode::IndexOutOfRange, "face " + std::to_string(f) + " has row " + std::to_string(*row) +
                                                  " of attribute '" + attribute.name + "', which has " +
                                                  std::to_string(attribute.values.rows()) + " rows");
    }
    if (std::any_of(begin, end, [](Index row) { return row < 0; })) std::fill(begin, end, -1);
  }
  return rows;
}

/// Cuts a mesh along the seams of an attribute.
class SeamCutter {
 public:
  SeamCutter(const Topology& topology, const Scheme& scheme, const Attribute& attribute)
      : topology_(topology),
        scheme_(scheme),
        rows_(checked_rows(topology, attribute)),
        row_is_taken_(static_cast<std::size_t>(attribute.values.rows()), 0) {
    const TopologyTables& given = topology.tables();
    tables_.uniform_face_size = given.uniform_face_size;
    tables_.face_offsets = given.face_offsets;
    tables_.faces = given.faces;
    tables_.holes = given.holes;
    tables_.vertex_count = static_cast<Index>(attribute.values.rows());
    tables_.vertex_half_edges.assign(row_is_taken_.size(), -1);
    sharpness_.assign(row_is_taken_.size(), 0.0F);
  }

  Topology cut() {
    cut_edges();
    tables_.origins.resize(rows_.size());
    for (Index v = 0; v < topology_.vertex_count(); ++v) {
      if (topology_.is_isolated(v)) continue;
      find_sectors(v);
      place_sectors(v);
    }
    const bool tagged = std::any_of(sharpness_.begin(), sharpness_.end(), is_sharp);
    if (tagged) tables_.vertex_sharpness = std::move(sharpness_);
    return Topology::from_tables(std::move(tables_));
  }

  /// Of the vertices after the attribute's own rows.
  const Buffer<Index>& added_rows() const { return added_rows_; }
  const Buffer<Index>& rows() const { return rows_; }
  std::vector<std::pair<Index, Index>> take_returning() { return std::move(returning_); }

 private:
  bool is_seam(Index h, Index twin) const {
    return rows_[h] != rows_[topology_.next(twin)] || rows_[topology_.next(h)] != rows_[twin];
  }

  void cut_edges() {
    tables_.twins = topology_.tables().twins;
    tables_.edges.resize(rows_.size());
    const bool creases = topology_.has_creases();
    for (Index h = 0; h < topology_.half_edge_count(); ++h) {
      const Index twin = topology_.twin(h);
      if (twin >= 0 && is_seam(h, twin)) tables_.twins[h] = -1;
      if (tables_.twins[h] >= 0 && twin < h) {
        tables_.edges[h] = tables_.edges[twin];
        continue;
      }
      tables_.edges[h] = static_cast<Index>(tables_.edge_half_edges.size());
      tables_.edge_half_edges.push_back(h);
      if (creases) tables_.edge_sharpness.push_back(topology_.tables().edge_sharpness[topology_.edge(h)]);
    }
  }

  /// Counter-clockwise from the first open edge.
  void find_sectors(Index v) {
    around_.clear();
    topology_.for_each_outgoing(v, [&](Index h) { around_.push_back(h); });
    const auto is_open = [&](Index h) { return tables_.twins[h] < 0; };
    const auto first = std::find_if(around_.begin(), around_.end(), is_open);
    const bool closed = first == around_.end();
    if (!closed) std::rotate(around_.begin(), first, around_.end());
    sectors_.clear();
    for (std::size_t i = 0; i < around_.size(); ++i) {
      const Index h = around_[i];
      if (is_open(h) || sectors_.empty()) sectors_.push_back({h, i, rows_[h]});
      Sector& sector = sectors_.back();
      ++sector.faces;
      sector.open = !closed;
      if (h == sector.start) continue;
      const float sharpness = topology_.edge_sharpness(topology_.edge(h));
      if (is_infinite(sharpness)) sector.divided = true;
      if (is_semi_sharp(sharpness)) sector.fading.push_back(sharpness);
    }
  }

  /// Gives the sectors of a vertex their vertices, and these their sharpness.
  void place_sectors(Index v) {
    const Index values = count_values();
    const bool together = are_corners_together(v, values);
    const float given = vertex_sharpness(topology_, scheme_, v);
    const bool dependent = values == 2 && !is_sharp(given) && depends_on_others();
    const auto fading = std::find_if(sectors_.begin(), sectors_.end(),
                                     [](const Sector& one) { return one.row >= 0 && !one.fading.empty(); });
    for (const Sector& sector : sectors_) {
      float sharpness = given;
      if (sector.row >= 0 && sector.open && (together || is_corner(sector))) {
        sharpness = kInfiniteSharpness;
      } else if (dependent && sector.row >= 0 && sector.fading.empty()) {
        if (fading != sectors_.end()) sharpness = last_to_fade(fading->fading);
      }
      place(sector, sharpness);
    }
    for (const Sector& sector : sectors_) {
      const Index vertex = tables_.origins[sector.start];
      const Index first_vertex = tables_.origins[sectors_[sector.first].start];
      if (vertex != first_vertex) returning_.emplace_back(vertex, first_vertex);
    }
  }

  /// The number of different rows. Says of each sector whether others have its row, and which is the first.
  Index count_values() {
    by_row_.resize(sectors_.size());
    std::iota(by_row_.begin(), by_row_.end(), std::size_t{0});
    const auto row = [&](std::size_t i) { return sectors_[i].row; };
    std::stable_sort(by_row_.begin(), by_row_.end(), [&](std::size_t a, std::size_t b) { return row(a) < row(b); });
    Index values = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < by_row_.size(); ++i) {
      Sector& sector = sectors_[by_row_[i]];
      sector.first = by_row_[i];
      if (sector.row < 0) continue;
      if (i == 0 || row(by_row_[i - 1]) != sector.row) {
        first = by_row_[i];
        ++values;
        continue;
      }
      sector.first = first;
      sectors_[first].repeated = sector.repeated = true;
    }
    return values;
  }

  bool depends_on_others() const {
    return scheme_.face_varying == FaceVaryingRule::CornersPlus1 ||
           scheme_.face_varying == FaceVaryingRule::CornersPlus2;
  }

  bool is_corner(const Sector& sector) const {
    return sector.repeated || scheme_.face_varying == FaceVaryingRule::Boundaries ||
           (sector.faces == 1 && scheme_.face_varying != FaceVaryingRule::None);
  }

  /// True where all values at the vertex are corners because of each other.
  bool are_corners_together(Index v, Index values) const {
    if (!depends_on_others()) return false;
    const bool plus2 = scheme_.face_varying == FaceVaryingRule::CornersPlus2;
    if (values == 1) return plus2 && !topology_.is_boundary_vertex(v);
    if (values != 2) return values > 2;
    return std::any_of(sectors_.begin(), sectors_.end(), [&](const Sector& sector) {
      return sector.row >= 0 && (sector.divided || sector.repeated || (plus2 && sector.faces == 1));
    });
  }

  void place(const Sector& sector, float sharpness) {
    const bool has_own = sector.row >= 0 && row_is_taken_[sector.row] == 0;
    Index vertex = sector.row;
    if (has_own) {
      row_is_taken_[sector.row] = 1;
    } else {
      if (tables_.vertex_count == std::numeric_limits<Index>::max()) {
        throw Error(ErrorCode::TooLarge, "values at corners have more than 2^31 - 1 places; split the mesh");
      }
      vertex = tables_.vertex_count++;
      added_rows_.push_back(sector.row);
      tables_.vertex_half_edges.push_back(-1);
      sharpness_.push_back(0.0F);
    }
    tables_.vertex_half_edges[vertex] = sector.start;
    sharpness_[vertex] = sharpness;
    for (Index i = 0; i < sector.faces; ++i) tables_.origins[around_[sector.place + i]] = vertex;
  }

  const Topology& topology_;
  const Scheme& scheme_;
  Buffer<Index> rows_;
  Buffer<std::uint8_t> row_is_taken_;  ///< by a vertex
  TopologyTables tables_;
  Buffer<float> sharpness_;  ///< of the vertices
  Buffer<Index> added_rows_;
  Buffer<Index> around_;  ///< the half-edges that leave a vertex
  std::vector<Sector> sectors_;
  std::vector<std::size_t> by_row_;  ///< the sectors, ordered by their rows
  std::vector<std::pair<Index, Index>> returning_;
};

}  // namespace

FaceVaryingSurface face_varying_surface(const Topology& topology, const Scheme& scheme, const Attribute& attribute) {
  require_finite(attribute.values, ("attribute '" + attribute.name + "'").c_str());
  SeamCutter cutter(topology, scheme, attribute);
  const Topology cut = cutter.cut();
  FaceVaryingSurface surface{cut, scheme, attribute.values, {}, cutter.take_returning()};
  surface.scheme.boundary = BoundaryRule::EdgeOnly;
  const Buffer<Index>& added = cutter.added_rows();
  surface.values.conservativeResize(cut.vertex_count(), Eigen::NoChange);
  for (std::size_t i = 0; i < added.size(); ++i) {
    auto row = surface.values.row(attribute.values.rows() + static_cast<Eigen::Index>(i));
    if (added[i] >= 0) row = attribute.values.row(added[i]);
    if (added[i] < 0) row.setZero();
  }
  const Buffer<Index>& rows = cutter.rows();
  if (std::all_of(rows.begin(), rows.end(), [](Index row) { return row >= 0; })) return surface;
  surface.without_values.resize(static_cast<std::size_t>(topology.face_count()));
  for (Index f = 0; f < topology.face_count(); ++f) {
    surface.without_values[f] = rows[topology.face_begin(f)] < 0 ? 1 : 0;
  }
  return surface;
}

FaceVaryingSurface FaceVaryingSurface::refined(const Progress& progress) const {
  constexpr double kConnected = 0.4;  // of the time
  const Refinement step(topology, scheme, {}, progress_within(progress, 0.0, kConnected));
  FaceVaryingSurface child{step.child(),
                           scheme.after_first_step(),
                           step.apply(values, progress_within(progress, kConnected, 1.0)),
                           {},
                           returning};
  if (without_values.empty()) return child;
  const bool quads = scheme.kind == SchemeKind::CatmullClark;
  child.without_values.resize(static_cast<std::size_t>(child.topology.face_count()));
  for (Index f = 0; f < child.topology.face_count(); ++f) {
    child.without_values[f] = without_values[quads ? topology.face(f) : f / 4];
  }
  return child;
}

Attribute FaceVaryingSurface::attribute(const std::string& name) const {
  Attribute result{name, values, topology.tables().origins};
  for (std::size_t f = 0; f < without_values.size(); ++f) {
    if (without_values[f] == 0) continue;
    const auto face = static_cast<Index>(f);
    std::fill(result.corner_rows.begin() + topology.face_begin(face),
              result.corner_rows.begin() + topology.face_end(face), -1);
  }
  if (returning.empty()) return result;
  const std::unordered_map<Index, Index> first_of(returning.begin(), returning.end());
  for (Index& row : result.corner_rows) {
    const auto found = first_of.find(row);
    if (found != first_of.end()) row = found->second;
  }
  return result;
}

}  // namespace batten
