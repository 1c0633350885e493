#include "batten/dynamics/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "batten/double4.h"
#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/solve/sparse_product.h"

namespace batten {

namespace {

constexpr std::ptrdiff_t kSampleBlock = 256;

std::vector<JetRow> jet_rows(int rows) {
  std::vector<JetRow> all{JetRow::Value, JetRow::Du, JetRow::Dv};
  all.resize(static_cast<std::size_t>(rows));
  return all;
}

/// A small triangle's corner counts a third of its area, a small square's a quarter.
SurfaceQuadrature grid_places(bool quads, int intervals) {
  constexpr double kInset = 1.0 / (1 << 20);
  const double step = 1.0 / intervals;
  const auto inside = [&](int i) { return kInset + i * step * (1.0 - (quads ? 2.0 : 3.0) * kInset); };
  SurfaceQuadrature grid;
  for (int j = 0; j <= intervals; ++j) {
    for (int i = 0; i <= (quads ? intervals : intervals - j); ++i) {
      grid.places.push_back({0, inside(i), inside(j)});
      const bool last = quads ? i == intervals || j == intervals : i + j == intervals;
      const int sides =
          (i == 0 ? 1 : 0) + (j == 0 ? 1 : 0) + (last ? 1 : 0) + (quads && i + j == 2 * intervals ? 1 : 0);
      const double corner = quads ? 0.25 : 1.0 / 6.0;
      grid.weights.push_back((sides == 0 ? 1.0 : sides == 1 ? 0.5 : corner) * step * step);
    }
  }
  return grid;
}

/// Calls body.operator()<N>() for the number of points of a table.
template <typename Body>
void with_points(const JetTable& table, const Body& body) {
  if (table.jets.cols() == kQuadPatchSize) return body.template operator()<kQuadPatchSize>();
  if (table.jets.cols() == kTrianglePatchSize) return body.template operator()<kTrianglePatchSize>();
  body.template operator()<Eigen::Dynamic>();
}

constexpr Eigen::Index kMostStackPoints = 64;

/// Calls body(points), `count` of them, on the stack where they are few.
template <int N, typename Body>
void with_scratch(Eigen::Index count, const Body& body) {
  if constexpr (N != Eigen::Dynamic) {
    Double4 points[N];
    return body(points);
  }
  if (count <= kMostStackPoints) {
    Double4 points[kMostStackPoints];
    return body(points);
  }
  Buffer<Double4> points(static_cast<std::size_t>(count));
  body(points.data());
}

/// result = jets * the points of the vertices.
template <int N>
void evaluate_rows(const JetTable& table, std::span<const Index> vertices, const Points& base, double* result) {
  const Eigen::Index count = N > 0 ? N : table.jets.cols();
  with_scratch<N>(count, [&](Double4* points) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const double* const p = base.data() + 3 * static_cast<std::ptrdiff_t>(vertices[static_cast<std::size_t>(i)]);
      points[i] = Double4{p[0], p[1], p[2], 0.0};
    }
    const double* weight = table.jets.data();
    for (Eigen::Index r = 0; r < table.jets.rows(); ++r, weight += count, result += 3) {
      Double4 even{};
      Double4 odd{};
      for (Eigen::Index i = 0; i + 1 < count; i += 2) {
        even += weight[i] * points[i];
        odd += weight[i + 1] * points[i + 1];
      }
      if (count % 2 != 0) even += weight[count - 1] * points[count - 1];
      const Double4 sum = even + odd;
      for (int c = 0; c < 3; ++c) result[c] = sum[c];
    }
  });
}

/// to = jets^T forces, row by row of three; forces are of each `step`-th row of the table.
template <int N>
void pull_back_rows(const JetTable& table, Eigen::Index step, const double* forces, double* to) {
  const Eigen::Index count = N > 0 ? N : table.jets.cols();
  with_scratch<N>(count, [&](Double4* sums) {
    std::fill(sums, sums + count, Double4{});
    const double* weight = table.jets.data();
    for (Eigen::Index r = 0; r < table.jets.rows(); r += step, weight += step * count, forces += 3) {
      const Double4 force{forces[0], forces[1], forces[2], 0.0};
      for (Eigen::Index i = 0; i < count; ++i) sums[i] += weight[i] * force;
    }
    for (Eigen::Index i = 0; i < count; ++i, to += 3) {
      for (int c = 0; c < 3; ++c) to[c] = sums[i][c];
    }
  });
}

}  // namespace

SurfaceSamples::SurfaceSamples(const SurfacePatches& patches, SampleRows rows)
    : patches_(patches), rows_(static_cast<int>(rows)), elements_(patches) {}

SurfaceSamples::SurfaceSamples(const SurfacePatches& patches, const GaussSamples& rule, SampleRows rows)
    : SurfaceSamples(patches, rows) {
  tables_ = jet_tables(patches_, elements_, jet_rows(rows_), rule.quadrature);
  list_places();
}

SurfaceSamples::SurfaceSamples(const SurfacePatches& patches, const GridSamples& rule, SampleRows rows)
    : SurfaceSamples(patches, rows) {
  if (rule.intervals < 1 || rule.intervals > 64) {
    throw Error(ErrorCode::BadArgument,
                "a grid of places has 1 to 64 intervals a side of a face, not " + std::to_string(rule.intervals));
  }
  const SurfaceQuadrature grid = grid_places(patches_.quads(), rule.intervals);
  for (Index kind = 0; kind < elements_.kind_count(); ++kind) {
    tables_.push_back(jet_table(patches_, elements_, kind, jet_rows(rows_), grid));
  }
  list_places();
}

void SurfaceSamples::list_places() {
  std::vector<Buffer<Index>> points;
  for (const JetTable& table : tables_) points.push_back(table.points);
  elements_.list_vertices(patches_, points);
  starts_.assign(1, 0);
  for (Index e = 0; e < elements_.count(); ++e) starts_.push_back(starts_.back() + table(e).places.size());
  if (patches_.has_first_step()) base_rows_ = first_step_rows(patches_);
}

Index SurfaceSamples::element_of(std::ptrdiff_t sample) const {
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), static_cast<std::size_t>(sample));
  return static_cast<Index>(after - starts_.begin()) - 1;
}

SurfacePlace SurfaceSamples::place(std::ptrdiff_t sample) const {
  const Index element = element_of(sample);
  const SurfacePlace& local = table(element).places[static_cast<std::size_t>(sample - begin(element))];
  return {elements_.base_face(element), local.u, local.v};
}

double SurfaceSamples::weight(std::ptrdiff_t sample) const {
  const Index element = element_of(sample);
  return table(element).weights[static_cast<std::size_t>(sample - begin(element))];
}

Points SurfaceSamples::base_points(const Points& control) const {
  if (!base_rows_) return control;
  Values result;
  multiply(base_rows_->rows, control, result);
  return result;
}

void SurfaceSamples::evaluate_element(Index element, const Points& base, double* result) const {
  const JetTable& of_kind = table(element);
  with_points(of_kind, [&]<int N>() { evaluate_rows<N>(of_kind, elements_.vertices(element), base, result); });
}

Points SurfaceSamples::evaluate(const Points& control) const {
  const Points base = base_points(control);
  Points result(rows_ * count(), 3);
  parallel_for(
      elements_.count(),
      [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        for (auto e = static_cast<Index>(first); e < static_cast<Index>(last); ++e) {
          evaluate_element(e, base, result.data() + 3 * rows_ * begin(e));
        }
      },
      kSampleBlock);
  return result;
}

Points SurfaceSamples::pull_back(const Points& forces) const {
  if (elements_.count() == 0) return Points::Zero(patches_.topology().vertex_count(), 3);
  const auto place_of = [&](Index element) { return 3 * elements_.start(element); };
  const Eigen::Index step = rows_ * count() / forces.rows();
  Buffer<double> of_elements(3 * elements_.vertices().size());
  parallel_for(
      elements_.count(),
      [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        for (auto e = static_cast<Index>(first); e < static_cast<Index>(last); ++e) {
          with_points(table(e), [&]<int N>() {
            pull_back_rows<N>(table(e), step, forces.data() + 3 * (rows_ / step) * begin(e),
                              of_elements.data() + place_of(e));
          });
        }
      },
      kSampleBlock);
  Values result(patches_.base().vertex_count(), 3);
  parallel_for(result.rows(), [&](std::ptrdiff_t first, std::ptrdiff_t last) {
    for (auto v = static_cast<Index>(first); v < static_cast<Index>(last); ++v) {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (const FaceElements::Use& use : elements_.uses(v)) {
        sum += Eigen::Map<const Eigen::RowVector3d>(of_elements.data() + place_of(use.element) + 3 * use.place);
      }
      result.row(v) = sum;
    }
  });
  if (!base_rows_) return result;
  Values of_control;
  multiply(base_rows_->transposed, result, of_control);
  return of_control;
}

std::shared_ptr<const PlaceRows> SurfaceSamples::point_rows(std::span<const std::ptrdiff_t> samples) const {
  PlaceRows::Matrix rows(static_cast<Eigen::Index>(samples.size()), patches_.base().vertex_count());
  std::size_t entries = 0;
  for (const std::ptrdiff_t sample : samples) entries += elements_.vertices(element_of(sample)).size();
  rows.reserve(static_cast<Eigen::Index>(entries));
  std::vector<std::pair<Index, double>> row;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Index element = element_of(samples[i]);
    const std::span<const Index> vertices = elements_.vertices(element);
    const auto weights = table(element).jets.row(rows_ * (samples[i] - begin(element)));
    row.clear();
    for (std::size_t j = 0; j < vertices.size(); ++j)
      row.emplace_back(vertices[j], weights[static_cast<Eigen::Index>(j)]);
    std::sort(row.begin(), row.end());
    rows.startVec(static_cast<Eigen::Index>(i));
    for (const auto& [vertex, weight] : row) rows.insertBack(static_cast<Eigen::Index>(i), vertex) = weight;
  }
  rows.finalize();
  auto result = std::make_shared<PlaceRows>();
  if (base_rows_) {
    result->rows = rows * base_rows_->rows;
  } else {
    result->rows.swap(rows);
  }
  result->transposed = result->rows.transpose();
  return result;
}

Scalars sample_areas(const SurfaceSamples& samples, const Points& jets) {
  Scalars areas(samples.count());
  parallel_for(
      samples.elements().count(),
      [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        for (auto e = static_cast<Index>(first); e < static_cast<Index>(last); ++e) {
          const std::vector<double>& weights = samples.table(e).weights;
          for (std::ptrdiff_t i = samples.begin(e); i < samples.end(e); ++i) {
            const Eigen::RowVector3d du = jets.row(3 * i + 1);
            const Eigen::RowVector3d dv = jets.row(3 * i + 2);
            areas[i] = weights[static_cast<std::size_t>(i - samples.begin(e))] * du.cross(dv).norm();
          }
        }
      },
      kSampleBlock);
  return areas;
}

Scalars element_areas(const SurfacePatches& patches, const Points& control) {
  const SurfaceSamples samples(patches, GaussSamples{{3, 2}});
  const Scalars areas = sample_areas(samples, samples.evaluate(control));
  Scalars sums(samples.elements().count());
  for (Index e = 0; e < samples.elements().count(); ++e) {
    sums[e] = areas.segment(samples.begin(e), samples.end(e) - samples.begin(e)).sum();
  }
  return sums;
}

}  // namespace batten
