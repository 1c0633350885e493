#include "batten/surface/surface_weights.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/limit/vertex_limit.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/halving.h"
#include "batten/patch/pieces.h"
#include "batten/patch/ring_steps.h"
#include "batten/patch/spline_jet.h"
#include "batten/refine/child_topology.h"
#include "batten/refine/refined_values.h"

namespace batten {

namespace {

using Row = std::vector<std::pair<Index, double>>;

/// Ascending, each vertex once, without zeros.
void tidy(Row& row) {
  std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (kept > 0 && row[kept - 1].first == row[i].first) {
      row[kept - 1].second += row[i].second;
    } else {
      row[kept++] = row[i];
    }
  }
  row.resize(kept);
  row.erase(std::remove_if(row.begin(), row.end(), [](const auto& entry) { return entry.second == 0.0; }), row.end());
}

/// Derivatives' weights deep down are large, and shrink on their way up only as far as they sum to zero: without this,
/// rounding would not shrink with them.
void keep_sum_zero(std::vector<double>& weights) { weights[0] -= std::accumulate(weights.begin(), weights.end(), 0.0); }

/// The first refinement around one control face: its base vertices as weights of control vertices.
struct FirstStep {
  Index face = -1;
  Buffer<Index> columns;                     ///< the control vertices around
  Values rows;                               ///< of the refined vertices around, on those
  std::unordered_map<Index, Index> numbers;  ///< of the base's vertices among them
};

}  // namespace

struct SurfaceWeights::Parts {
  Topology control;
  Scheme scheme;
  bool quads;
  std::unique_ptr<Refinement> first;
  Scheme base_scheme;
  PatchFinder finder;
  RingSteps steps;
  Buffer<Index> kinds;              ///< of base faces; RingSteps::kPatch for regular ones
  Buffer<std::size_t> ring_starts;  ///< F + 1
  Buffer<Index> rings;

  Parts(const Topology& topology, const Scheme& scheme_in)
      : control(topology),
        scheme(scheme_in),
        quads(scheme_in.kind == SchemeKind::CatmullClark),
        first(needs_first_step(topology, scheme_in) ? std::make_unique<Refinement>(topology, scheme_in) : nullptr),
        base_scheme(scheme_in.after_first_step()),
        finder(base(), base_scheme),
        steps(scheme_in),
        ring_starts{0} {
    RegularPatch patch;
    FaceRing ring;
    for (Index f = 0; f < base().face_count(); ++f) {
      const Index side = base().face_begin(f);
      const bool regular = finder.find(side, patch);
      if (!regular) {
        ring.gather(base(), base_scheme, side);
        rings.insert(rings.end(), ring.vertices().begin(), ring.vertices().end());
      }
      kinds.push_back(regular ? RingSteps::kPatch : steps.kind_of(base(), ring));
      ring_starts.push_back(rings.size());
    }
  }

  const Topology& base() const { return first == nullptr ? control : first->child(); }
  const std::array<double, 16>& patch_weights(double u, double v, JetPart part, JetWeights& weights) const;
  void add_patch_row(Index face, const std::array<double, 16>& weights, Row& row) const;
  void add_ring_row(const SurfacePlace& place, JetPart part, Row& row) const;
  void add_vertex_row(const SurfacePlace& place, JetPart part, Row& row) const;
  void step_around(Index face, FirstStep& step) const;
  Row by_control(const FirstStep& step, const Row& of_base) const;
  Row row(const SurfacePlace& place, JetPart part, FirstStep& step) const;
};

const std::array<double, 16>& SurfaceWeights::Parts::patch_weights(double u, double v, JetPart part,
                                                                   JetWeights& weights) const {
  if (quads) {
    quad_jet_weights(u, v, weights);
  } else {
    triangle_jet_weights(u, v, weights);
  }
  switch (part) {
    case JetPart::Point:
      return weights.value;
    case JetPart::Du:
      return weights.du;
    case JetPart::Dv:
      return weights.dv;
    case JetPart::Duu:
      return weights.duu;
    case JetPart::Duv:
      return weights.duv;
    default:
      return weights.dvv;
  }
}

/// What is missing of the patch follows from the rest by reflection.
void SurfaceWeights::Parts::add_patch_row(Index face, const std::array<double, 16>& weights, Row& row) const {
  RegularPatch patch;
  finder.find(base().face_begin(face), patch);
  const int count = quads ? kQuadPatchSize : kTrianglePatchSize;
  const auto* const end = patch.rows.data() + count;
  if (std::find(static_cast<const Index*>(patch.rows.data()), end, RegularPatch::kMissing) == end) {
    for (int i = 0; i < count; ++i) row.emplace_back(patch.rows[i], weights[i]);
    return;
  }
  Values points = Values::Identity(count, count);
  if (quads) {
    complete_quad_patch(patch.rows.data(), points.data(), count);
  } else {
    complete_triangle_patch(patch.rows.data(), points.data(), count);
  }
  for (int j = 0; j < count; ++j) {
    if (patch.rows[j] == RegularPatch::kMissing) continue;
    double weight = 0.0;
    for (int i = 0; i < count; ++i) weight += weights[i] * points(i, j);
    row.emplace_back(patch.rows[j], weight);
  }
}

/// Down to the patch, then its weights back up to the ring.
void SurfaceWeights::Parts::add_ring_row(const SurfacePlace& place, JetPart part, Row& row) const {
  double u = place.u;
  double v = place.v;
  double scale = 1.0;
  std::vector<std::pair<Index, int>> path;
  for (Index kind = kinds[place.face]; kind != RingSteps::kPatch;) {
    if (path.size() == kHalvingsToVertex) return add_vertex_row(place, part, row);
    const Halving step = halve(quads, u, v);
    scale *= step.factor;
    path.emplace_back(kind, step.child);
    kind = steps.child(kind, step.child).kind;
  }
  JetWeights jet;
  const auto& patch = patch_weights(u, v, part, jet);
  const bool is_first = part == JetPart::Du || part == JetPart::Dv;
  const double factor = part == JetPart::Point ? 1.0 : is_first ? scale : scale * scale;
  std::vector<double> weights(patch.begin(), patch.begin() + (quads ? kQuadPatchSize : kTrianglePatchSize));
  for (double& weight : weights) weight *= factor;
  const bool is_point = part == JetPart::Point;
  if (!is_point) keep_sum_zero(weights);
  for (std::size_t i = path.size(); i-- > 0;) {
    const RingSteps::Step& step = steps.step(path[i].first);
    const Buffer<Index>& child = step.children[path[i].second];
    std::vector<double> above(static_cast<std::size_t>(step.ring_size), 0.0);
    for (std::size_t p = 0; p < child.size(); ++p) {
      for (Index e = step.rows.starts[child[p]]; e < step.rows.starts[child[p] + 1]; ++e) {
        above[step.rows.columns[e]] += weights[p] * step.rows.weights[e];
      }
    }
    weights = std::move(above);
    if (!is_point) keep_sum_zero(weights);
  }
  for (std::size_t i = 0; i < weights.size(); ++i) row.emplace_back(rings[ring_starts[place.face] + i], weights[i]);
}

void SurfaceWeights::Parts::add_vertex_row(const SurfacePlace& place, JetPart part, Row& row) const {
  if (part == JetPart::Duu || part == JetPart::Duv || part == JetPart::Dvv) return;
  const Index corner = nearest_corner(quads, place.u, place.v);
  const TileValue value = part == JetPart::Point ? TileValue::Limit
                          : part == JetPart::Du  ? TileValue::TangentU
                                                 : TileValue::TangentV;
  visit_vertex_limit(base(), base_scheme, value, base().face_begin(place.face) + corner,
                     [&](Index vertex, double weight) { row.emplace_back(vertex, weight); });
}

/// Under Chaikin's rule, whose edges look at the far ends' other edges, the faces there are needed too.
void SurfaceWeights::Parts::step_around(Index face, FirstStep& step) const {
  if (step.face == face) return;
  step.face = face;
  Buffer<Index> half_edges{control.face_begin(face)};
  Buffer<Index> sorted{face};
  std::size_t done = 0;
  for (int ring = scheme.crease_method == CreaseMethod::Chaikin ? 2 : 1; ring > 0; --ring) {
    for (const std::size_t end = half_edges.size(); done < end; ++done) {
      const Index around = control.face(half_edges[done]);
      for (Index h = control.face_begin(around); h < control.face_end(around); ++h) {
        control.for_each_outgoing(control.origin(h), [&](Index outgoing) {
          const Index found = control.face(outgoing);
          const auto place = std::lower_bound(sorted.begin(), sorted.end(), found);
          if (place != sorted.end() && *place == found) return;
          sorted.insert(place, found);
          half_edges.push_back(control.face_begin(found));
        });
      }
    }
  }
  Cutting cutting = cut_out(control, half_edges);
  const Topology& part = cutting.topology;
  step.columns = std::move(cutting.rows);
  const Index count = part.vertex_count();
  step.rows.resize(refined_vertex_count(part, scheme.kind), count);
  refine_values(part, scheme, {}, Values::Identity(count, count), step.rows.data());
  step.numbers.clear();
  const Index edges = control.vertex_count();
  const Index faces = edges + control.edge_count();
  for (std::size_t f = 0; f < half_edges.size(); ++f) {
    const auto local_face = static_cast<Index>(f);
    step.numbers[faces + control.face(half_edges[f])] = count + part.edge_count() + local_face;
    for (Index c = 0; c < part.face_size(local_face); ++c) {
      const Index local = part.face_begin(local_face) + c;
      step.numbers[control.origin(half_edges[f] + c)] = part.origin(local);
      step.numbers[edges + control.edge(half_edges[f] + c)] = count + part.edge(local);
    }
  }
}

Row SurfaceWeights::Parts::by_control(const FirstStep& step, const Row& of_base) const {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(step.rows.cols());
  for (const auto& [vertex, weight] : of_base) {
    if (weight != 0.0) sum += weight * step.rows.row(step.numbers.at(vertex));
  }
  Row row;
  row.reserve(step.columns.size());
  for (Eigen::Index i = 0; i < sum.size(); ++i) row.emplace_back(step.columns[i], sum[i]);
  return row;
}

Row SurfaceWeights::Parts::row(const SurfacePlace& place, JetPart part, FirstStep& step) const {
  Row row;
  if (kinds[place.face] == RingSteps::kPatch) {
    JetWeights jet;
    add_patch_row(place.face, patch_weights(place.u, place.v, part, jet), row);
  } else {
    add_ring_row(place, part, row);
  }
  if (first != nullptr) {
    step_around(control.face(place.face), step);  // the base's quad h belongs to half-edge h
    row = by_control(step, row);
  }
  tidy(row);
  return row;
}

SurfaceWeights::SurfaceWeights(const Topology& topology, const Scheme& scheme) {
  require_triangles(topology, scheme);
  parts_ = std::make_unique<Parts>(topology, scheme);
}

SurfaceWeights::~SurfaceWeights() = default;
SurfaceWeights::SurfaceWeights(SurfaceWeights&&) noexcept = default;

const Topology& SurfaceWeights::base() const { return parts_->base(); }

Eigen::SparseMatrix<double, Eigen::RowMajor> SurfaceWeights::rows(std::span<const SurfacePlace> places, JetPart part,
                                                                  const Progress& progress) const {
  for (const SurfacePlace& place : places) require_place(base(), place);
  // Places of one face in a row: they share the first refinement around it.
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return places[a].face < places[b].face; });
  std::vector<Row> rows(places.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(places.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        FirstStep step;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          rows[order[i]] = parts_->row(places[order[i]], part, step);
        }
      },
      256, progress);
  std::size_t entries = 0;
  for (const Row& row : rows) entries += row.size();
  if (entries > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::TooLarge, std::to_string(places.size()) + " places have " + std::to_string(entries) +
                                         " weights, more than 2^31 - 1; ask for fewer at a time");
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(static_cast<Eigen::Index>(places.size()),
                                                      parts_->control.vertex_count());
  matrix.resizeNonZeros(static_cast<Eigen::Index>(entries));
  int next = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    matrix.outerIndexPtr()[i] = next;
    for (const auto& [column, weight] : rows[i]) {
      matrix.innerIndexPtr()[next] = column;
      matrix.valuePtr()[next++] = weight;
    }
  }
  matrix.outerIndexPtr()[rows.size()] = next;
  return matrix;
}

}  // namespace batten
