#include "batten/adaptive/adaptive.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "batten/adaptive/butterfly_points.h"
#include "batten/adaptive/cell_faces.h"
#include "batten/adaptive/chord_cells.h"
#include "batten/adaptive/corner_normals.h"
#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/surface_patches.h"
#include "batten/progress.h"
#include "batten/refine/refinement.h"

namespace batten {

namespace {

/// So many jets at a time: they are large.
constexpr std::ptrdiff_t kChunk = 1 << 15;

void check(const AdaptiveOptions& options, const Scheme& scheme) {
  const auto bad = [](const std::string& what) { throw Error(ErrorCode::BadArgument, what); };
  const std::pair<const char*, double> bounds[] = {
      {"chord tolerance", options.chord}, {"edge length", options.edge_length}, {"angle", options.angle}};
  for (const auto& [name, bound] : bounds) {
    if (bound >= 0.0 && std::isfinite(bound)) continue;
    std::ostringstream what;
    what << "the " << name << " is " << bound << "; it must be positive, or 0 where it is not asked for";
    bad(what.str());
  }
  if (options.chord == 0.0 && options.edge_length == 0.0 && options.angle == 0.0 && !options.cut) {
    bad("adaptive tessellation needs a chord tolerance, an edge length, an angle or a bound of your own");
  }
  if (is_interpolating(scheme.kind) && options.chord > 0.0) {
    bad(std::string(scheme_name(scheme.kind)) +
        " surfaces have no closed form to measure a chord by; take an edge length or an angle");
  }
  if (is_interpolating(scheme.kind) && options.faces == FaceKind::Quads) {
    bad(std::string(scheme_name(scheme.kind)) + " surfaces are tessellated in triangles, not in quads");
  }
  if (options.max_level < 0 || options.max_level > CellForest::kMostLevels) {
    bad("cells have 0 to " + std::to_string(CellForest::kMostLevels) + " levels, not " +
        std::to_string(options.max_level));
  }
  if (options.max_faces < 1) bad("at least one face must be allowed");
}

double angle_between(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b) {
  if (a.squaredNorm() == 0.0 || b.squaredNorm() == 0.0) return 0.0;
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

/// A forest and the mesh of its leaves, made anew after each cut.
class AdaptiveBuilder {
 public:
  AdaptiveBuilder(const SurfacePatches& patches, ConstValuesRef control, const AdaptiveOptions& options)
      : patches_(patches),
        control_(control),
        options_(options),
        surface_(is_interpolating(patches.scheme().kind) ? nullptr : std::make_unique<LimitSurface>(patches_, control)),
        butterfly_(surface_ != nullptr
                       ? nullptr
                       : std::make_unique<ButterflyPoints>(patches.topology(), patches.scheme(), control)),
        forest_(base(), patches_.holes()),
        quads_(options.faces == FaceKind::Quads) {
    add_vertices(forest_.vertex_places(), 0);
  }

  AdaptiveMesh build(const Progress& progress) {
    quartered_ = quads_ && !base_suffices();
    if (options_.chord > 0.0) {
      cut_by_chord_tolerance(progress_within(progress, 0.0, 0.5));
    }
    // The number of rounds shows at the end only: each is given half of what is left.
    for (double left = 0.5;; left *= 0.5) {
      report_progress(progress, 1.0 - left);
      close();
      const Buffer<Index> cells = beyond_measure(progress_within(progress, 1.0 - left, 1.0 - 0.5 * left));
      if (cells.empty()) break;
      for (const Index cell : cells) forest_.split(cell);
    }
    return finish();
  }

 private:
  const Topology& base() const { return patches_.base(); }
  void evaluate(std::span<const SurfacePlace> places, Eigen::Ref<Points> points, Eigen::Ref<Points> normals) const;
  void add_vertices(std::span<const SurfacePlace> places, Index first);
  const CellNets& nets() {
    if (nets_ == nullptr) nets_ = std::make_unique<CellNets>(patches_, control_);
    return *nets_;
  }
  bool base_suffices();
  void cut_by_chord_tolerance(const Progress& progress);
  Index least_faces_per_leaf() const {
    return quartered_ ? forest_.corner_count() : quads_ ? 1 : forest_.corner_count() - 2;
  }
  void require_room(std::int64_t faces) const;
  void close();
  Buffer<Index> beyond_measure(const Progress& progress);
  void measure_edges(Buffer<std::uint8_t>& beyond);
  void measure_angles(Buffer<std::uint8_t>& beyond, const Progress& progress);
  void measure_by_cut(Buffer<std::uint8_t>& beyond) const;
  Eigen::RowVector3d corner_normal(std::size_t corner) const {
    return normals_.corner_rows.empty() ? normals_.rows.row(faces_.vertices[corner])
                                        : normals_.rows.row(normals_.corner_rows[corner]);
  }
  AdaptiveMesh finish();

  SurfacePatches patches_;
  const Eigen::Ref<const Values, 0, Eigen::OuterStride<>> control_;
  const AdaptiveOptions& options_;
  std::unique_ptr<LimitSurface> surface_;  ///< one of these two
  std::unique_ptr<ButterflyPoints> butterfly_;
  std::unique_ptr<CellNets> nets_;
  CellForest forest_;
  bool quads_;
  bool quartered_ = false;
  Points points_ = Points(0, 3);  ///< of the forest's vertices, then of those added
  Points vertex_normals_ = Points(0, 3);
  Index evaluated_ = 0;  ///< vertices of the forest
  CellFaces faces_;
  CornerNormals normals_;
  Buffer<Index> beyond_chord_;  ///< cells of the last level
  Index unmet_ = 0;             ///< as the last measure found
  double longest_edge_ = 0.0;
  double widest_angle_ = 0.0;
};

/// Rows from `first` on.
void AdaptiveBuilder::add_vertices(std::span<const SurfacePlace> places, Index first) {
  const auto count = static_cast<std::ptrdiff_t>(places.size());
  points_.conservativeResize(first + count, 3);
  vertex_normals_.conservativeResize(first + count, 3);
  evaluate(places, points_.bottomRows(count), vertex_normals_.bottomRows(count));
}

void AdaptiveBuilder::evaluate(std::span<const SurfacePlace> places, Eigen::Ref<Points> points,
                               Eigen::Ref<Points> normals) const {
  if (butterfly_ != nullptr) return butterfly_->evaluate(places, points, normals);
  const auto count = static_cast<std::ptrdiff_t>(places.size());
  std::vector<Jet> jets;
  for (std::ptrdiff_t begin = 0; begin < count; begin += kChunk) {
    const std::ptrdiff_t size = std::min(kChunk, count - begin);
    jets.resize(static_cast<std::size_t>(size));
    surface_->jets(places.subspan(static_cast<std::size_t>(begin), jets.size()), jets);
    for (std::ptrdiff_t i = 0; i < size; ++i) {
      points.row(begin + i) = jets[i].point.transpose();
      normals.row(begin + i) = unit_normal(jets[i]).transpose();
    }
  }
}

/// Quads of the base itself will do: nothing to cut, so nothing to close.
bool AdaptiveBuilder::base_suffices() {
  if (forest_.corner_count() != 4) return false;
  if (options_.chord > 0.0 && !roots_suffice(nets(), *surface_, points_, options_.chord, forest_)) return false;
  close();
  return beyond_measure({}).empty() && unmet_ == 0;
}

void AdaptiveBuilder::cut_by_chord_tolerance(const Progress& progress) {
  const Index most = most_faces(options_.max_faces, quads_ ? 4 : 3);
  const ChordRule rule{options_.chord, quartered_, options_.max_level, most / least_faces_per_leaf()};
  beyond_chord_ = cut_by_chord(nets(), *surface_, points_, rule, forest_, progress);
}

void AdaptiveBuilder::require_room(std::int64_t faces) const {
  const Index most = most_faces(options_.max_faces, quads_ ? 4 : 3);
  if (faces <= most) return;
  const std::string room = most < options_.max_faces ? " faces that a mesh can have; take larger bounds or fewer levels"
                                                     : " faces allowed; take larger bounds, fewer levels or allow more "
                                                       "faces";
  throw Error(ErrorCode::TooLarge, "the bounds make more than the " + std::to_string(most) + room);
}

void AdaptiveBuilder::close() {
  const Index vertices = forest_.vertex_count();
  const std::span<const SurfacePlace> places = forest_.vertex_places();
  add_vertices(places.subspan(static_cast<std::size_t>(evaluated_)), evaluated_);
  evaluated_ = vertices;
  require_room(std::int64_t{least_faces_per_leaf()} * static_cast<std::int64_t>(forest_.leaves().size()));
  faces_ = quartered_ ? quads_of(forest_) : quads_ ? leaves_of(forest_) : triangles_of(forest_, points_);
  require_room(static_cast<std::int64_t>(faces_.cells.size()));
  if (!faces_.added.empty()) add_vertices(faces_.added, vertices);
  const auto normals_at = [&](std::span<const SurfacePlace> at) {
    Points points(static_cast<Eigen::Index>(at.size()), 3);
    Points normals(points.rows(), 3);
    evaluate(at, points, normals);
    return normals;
  };
  normals_ = corner_normals(normals_at, faces_, forest_, vertex_normals_);
}

void AdaptiveBuilder::measure_edges(Buffer<std::uint8_t>& beyond) {
  const auto size = static_cast<std::size_t>(faces_.size);
  longest_edge_ = parallel_reduce(
      faces_.count(), 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double longest = 0.0;
        for (std::ptrdiff_t f = begin; f < end; ++f) {
          double longest_here = 0.0;
          const Index* face = &faces_.vertices[static_cast<std::size_t>(f) * size];
          for (std::size_t k = 0; k < size; ++k) {
            const Index next = face[k + 1 == size ? 0 : k + 1];
            longest_here = std::max(longest_here, (points_.row(face[k]) - points_.row(next)).norm());
          }
          longest = std::max(longest, longest_here);
          if (options_.edge_length > 0.0 && longest_here > options_.edge_length) beyond[f] = 1;
        }
        return longest;
      },
      [](double a, double b) { return std::max(a, b); });
}

/// Corners of a face among each other, and each with the middle.
void AdaptiveBuilder::measure_angles(Buffer<std::uint8_t>& beyond, const Progress& progress) {
  const auto size = static_cast<std::size_t>(faces_.size);
  std::vector<SurfacePlace> places;
  std::vector<Jet> jets;
  widest_angle_ = 0.0;
  for (std::ptrdiff_t begin = 0; begin < faces_.count(); begin += kChunk) {
    report_progress(progress, static_cast<double>(begin) / faces_.count());
    const std::ptrdiff_t count = std::min<std::ptrdiff_t>(kChunk, faces_.count() - begin);
    places.resize(static_cast<std::size_t>(count));
    jets.resize(places.size());
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      places[i] = {forest_.face(faces_.cells[begin + i]), 0.0, 0.0};
      for (std::size_t k = 0; k < size; ++k) {
        const std::array<double, 2>& at = faces_.places[static_cast<std::size_t>(begin + i) * size + k];
        places[i].u += at[0] / faces_.size;
        places[i].v += at[1] / faces_.size;
      }
    }
    // Butterfly surfaces have no normals at other places than vertices.
    if (surface_ != nullptr) surface_->jets(places, jets);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const std::size_t first = static_cast<std::size_t>(begin + i) * size;
      const Eigen::RowVector3d middle = unit_normal(jets[i]).transpose();
      double widest = 0.0;
      for (std::size_t k = 0; k < size; ++k) {
        if (surface_ != nullptr) widest = std::max(widest, angle_between(middle, corner_normal(first + k)));
        for (std::size_t j = 0; j < k; ++j) {
          widest = std::max(widest, angle_between(corner_normal(first + j), corner_normal(first + k)));
        }
      }
      widest_angle_ = std::max(widest_angle_, widest);
      if (widest > options_.angle) beyond[begin + i] = 1;
    }
  }
}

void AdaptiveBuilder::measure_by_cut(Buffer<std::uint8_t>& beyond) const {
  Points points(faces_.size, 3);
  Points normals(faces_.size, 3);
  for (Index f = 0; f < faces_.count(); ++f) {
    const auto first = static_cast<std::size_t>(f) * static_cast<std::size_t>(faces_.size);
    for (Index k = 0; k < faces_.size; ++k) {
      points.row(k) = points_.row(faces_.vertices[first + static_cast<std::size_t>(k)]);
      normals.row(k) = corner_normal(first + static_cast<std::size_t>(k));
    }
    const Index cell = faces_.cells[f];
    if (options_.cut({forest_.face(cell), forest_.level(cell), points, normals})) beyond[f] = 1;
  }
}

/// The cells with faces beyond the edge length, the angle or the caller's bound; those of the last level are counted
/// instead, each once, whatever it is beyond.
Buffer<Index> AdaptiveBuilder::beyond_measure(const Progress& progress) {
  Buffer<std::uint8_t> beyond(static_cast<std::size_t>(faces_.count()), 0);
  measure_edges(beyond);
  if (options_.angle > 0.0) measure_angles(beyond, progress);
  if (options_.cut) measure_by_cut(beyond);
  Buffer<std::uint8_t> met(static_cast<std::size_t>(forest_.cell_count()), 1);
  for (const Index cell : beyond_chord_) met[cell] = 0;
  unmet_ = static_cast<Index>(beyond_chord_.size());
  Buffer<Index> cells;
  for (Index f = 0; f < faces_.count(); ++f) {
    const Index cell = faces_.cells[f];
    if (beyond[f] == 0 || met[cell] == 0) continue;
    met[cell] = 0;
    if (forest_.level(cell) < options_.max_level) {
      cells.push_back(cell);
    } else {
      ++unmet_;
    }
  }
  return cells;
}

AdaptiveMesh AdaptiveBuilder::finish() {
  AdaptiveMesh result;
  Mesh& mesh = result.mesh;
  const std::size_t corners = faces_.vertices.size();
  const auto size = static_cast<std::size_t>(faces_.size);
  mesh.face_offsets.resize(corners / size + 1);
  for (std::size_t f = 0; f <= corners / size; ++f) mesh.face_offsets[f] = static_cast<Index>(f * size);
  result.places.assign(forest_.vertex_places().begin(), forest_.vertex_places().end());
  result.places.insert(result.places.end(), faces_.added.begin(), faces_.added.end());
  mesh.points = std::move(points_);
  mesh.face_vertices = std::move(faces_.vertices);
  mesh.attributes.push_back({"normal", Values(vertex_normals_), {}});
  if (!normals_.corner_rows.empty()) {
    mesh.attributes.push_back({"normal", std::move(normals_.rows), std::move(normals_.corner_rows)});
  }
  for (const Index cell : faces_.cells) result.base_faces.push_back(forest_.face(cell));
  result.corner_parameters = std::move(faces_.places);
  result.deepest_level = forest_.deepest_level();
  result.unmet = unmet_;
  result.longest_edge = longest_edge_;
  result.widest_angle = widest_angle_;
  return result;
}

}  // namespace

AdaptiveMesh tessellate_adaptively(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                                   const AdaptiveOptions& options, const Progress& progress) {
  check(options, scheme);
  return tessellate_adaptively(SurfacePatches(topology, scheme), control, options, progress);
}

AdaptiveMesh tessellate_adaptively(const SurfacePatches& patches, ConstValuesRef control,
                                   const AdaptiveOptions& options, const Progress& progress) {
  check(options, patches.scheme());
  AdaptiveBuilder builder(patches, control, options);
  return builder.build(progress);
}

}  // namespace batten
