#include "batten/fit/contour_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/fit/contour_gaps.h"
#include "batten/fit/contour_parts.h"
#include "batten/fit/dual_contour.h"
#include "batten/fit/loop_moves.h"
#include "batten/fit/outliers.h"
#include "batten/fit/paired_quads.h"
#include "batten/fit/quad_turns.h"
#include "batten/fit/relaxed_contour.h"
#include "batten/fit/sharp_edges.h"
#include "batten/fit/sharp_normals.h"
#include "batten/fit/simplified.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr Index kSupportPlaces = 1500;
constexpr int kRelaxRounds = 3;
constexpr int kTurnRounds = 3;

/// The genus and number of components.
struct Shape {
  Index genus = 0;
  Index components = 0;
  Index loops = 0;
  std::array<Index, 3> numbers() const { return {genus, components, loops}; }
  bool operator<(const Shape& other) const { return numbers() < other.numbers(); }
  bool operator==(const Shape& other) const { return numbers() == other.numbers(); }
};

struct Candidate {
  FoundContour contour;
  Shape shape;
};

Shape shape_of(const Mesh& mesh) {
  Shape shape;
  for (const FirstMeshPart& part : mesh_parts(mesh)) {
    shape.genus += part.genus;
    ++shape.components;
    shape.loops += part.boundary_loops;
  }
  return shape;
}

/// The contour on a grid of this spacing, moved by parts of it.
Candidate contour_at(const CloudField& field, const Points& places, double spacing, const Eigen::RowVector3d& move,
                     double bridge) {
  const ValueGrid& fine = field.grid;
  Eigen::RowVector3d low = fine.origin;
  Eigen::RowVector3d high = fine.origin;
  for (int c = 0; c < 3; ++c) high(c) += fine.spacing * (fine.nodes[c] - 1);
  ValueGrid grid = grid_over(low - spacing * (Eigen::RowVector3d::Ones() - move),
                             high + spacing * Eigen::RowVector3d::Ones(), spacing);
  parallel_for_each(grid.nodes[2], [&](std::ptrdiff_t k) {
    for (Index j = 0; j < grid.nodes[1]; ++j) {
      for (Index i = 0; i < grid.nodes[0]; ++i)
        grid.values[grid.node(i, j, static_cast<Index>(k))] =
            static_cast<float>(fine.at(grid.place(i, j, static_cast<Index>(k))));
    }
  });
  Candidate candidate;
  candidate.contour.mesh = dual_contour(grid);
  candidate.contour.spacing = spacing;
  if (candidate.contour.mesh.face_count() == 0) return candidate;
  candidate.contour.dropped = drop_unsupported(candidate.contour.mesh, places);
  cut_gaps(candidate.contour.mesh, field, spacing, bridge);
  candidate.shape = shape_of(candidate.contour.mesh);
  return candidate;
}

/// Contours of grids nearly as fine as the field's, the finest first within each pair. More are made as long as they
/// disagree about the shape, or until one has the genus asked for.
std::vector<Candidate> fine_contours(const CloudField& field, const Points& places, const std::optional<Index>& genus,
                                     double bridge, const Progress& progress) {
  constexpr std::array<double, 6> kShares{1.0, 1.25, 1.12, 1.4, 1.06, 1.5};
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < kShares.size(); ++i) {
    for (const double move : {0.0, 0.5}) {
      report_progress(progress, (static_cast<double>(i) + move) / kShares.size());
      const Eigen::RowVector3d moves = Eigen::RowVector3d::Constant(move);
      candidates.push_back(contour_at(field, places, kShares[i] * field.grid.spacing, moves, bridge));
    }
    const Shape& first = candidates[0].shape;
    const bool same = std::all_of(candidates.begin(), candidates.end(),
                                  [&](const Candidate& candidate) { return candidate.shape == first; });
    if (i > 0 && same && (!genus || first.genus == *genus)) break;
  }
  return candidates;
}

/// The first contour of the shape that most have, or that most of those with the genus asked for have; of equals the
/// simplest. nullptr where there is none.
Candidate* most_frequent(std::vector<Candidate>& candidates, const std::optional<Index>& genus) {
  std::map<Shape, int> votes;
  for (const Candidate& candidate : candidates) ++votes[candidate.shape];
  Shape wanted;
  int most = 0;
  for (const auto& vote : votes) {
    if (vote.first.components == 0 || vote.second <= most || (genus && vote.first.genus != *genus)) continue;
    most = vote.second;
    wanted = vote.first;
  }
  const auto found = std::find_if(candidates.begin(), candidates.end(),
                                  [&](const Candidate& candidate) { return candidate.shape == wanted; });
  return most == 0 ? nullptr : &*found;
}

/// The spacing at which about so many vertices come out.
double spacing_for(const CloudField& field, const Points& places, Index vertices, double bridge) {
  constexpr int kRounds = 8;
  constexpr double kNear = 0.02;
  double spacing = std::sqrt(1.5 * field.samples.areas.sum() / vertices);
  for (int round = 0; round < kRounds; ++round) {
    spacing = std::min(std::max(spacing, 0.5 * field.grid.spacing), 0.5);
    const Candidate candidate = contour_at(field, places, spacing, Eigen::RowVector3d::Zero(), bridge);
    const auto count = static_cast<double>(candidate.contour.mesh.vertex_count());
    if (std::abs(count / vertices - 1.0) < kNear) break;
    spacing *= std::min(1.6, std::max(0.6, std::sqrt(count / vertices)));
  }
  return spacing;
}

/// The coarse contour of the wanted shape with about so many vertices; without faces where no grid gives one.
FoundContour coarse_contour(const CloudField& field, const Points& places, const Shape& wanted, Index vertices,
                            double bridge) {
  constexpr double kGoodEnough = 0.05;
  constexpr double kTooBad = 0.35;
  const double spacing = spacing_for(field, places, vertices, bridge);
  double least = kTooBad;
  FoundContour best;
  for (const double share : {1.0, 0.97, 1.03, 0.94, 1.06, 0.9, 0.85}) {
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::RowVector3d move = 0.5 * Eigen::RowVector3d(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      Candidate candidate = contour_at(field, places, spacing * share, move, bridge);
      if (!(candidate.shape == wanted)) continue;
      const double badness = std::abs(std::log(static_cast<double>(candidate.contour.mesh.vertex_count()) / vertices));
      if (badness >= least) continue;
      least = badness;
      best = std::move(candidate.contour);
    }
    if (least < kGoodEnough) break;
  }
  return best;
}

/// Triangles along the sharp edges of the samples, which become creases, or with smooth ones alone.
void coarsen(Mesh& mesh, const CloudField& field, const FirstMeshOptions& options, const Progress& progress) {
  if (options.creases == CreaseSearch::None) {
    mesh = simplified(triangulated(mesh), options.vertices, progress);
    return;
  }
  const CloudSamples& samples = field.samples;
  const NeighbourTable neighbours = find_neighbours(field.tree, kCloudNeighbours);
  const Points normals = sharp_normals(samples.points, samples.normals, neighbours);
  constexpr double kReach = 2.5;  // of the spacing of samples: more than twelve vertices of a fine contour
  const SamplePlanes planes{samples.points, normals, samples.areas, kReach * samples.typical};
  Mesh sharp = simplified(triangulated(mesh), planes, options.vertices, progress_within(progress, 0.0, 0.4));
  turn_to_points(sharp, field.tree, normals);
  sharp.creases = find_sharp_edges(sharp, field.tree, normals, samples.typical);
  if (options.faces == FaceKind::Quads && !sharp.creases.empty()) {
    constexpr int kSweeps = 3;
    sharp = improve_loop_mesh(sharp, samples.points, {options.vertices, true, kSweeps, samples.typical},
                              progress_within(progress, 0.4, 0.8));
  }
  if (sharp.creases.empty())
    sharp = simplified(triangulated(mesh), options.vertices, progress_within(progress, 0.8, 1.0));
  mesh = std::move(sharp);
}

[[noreturn]] void refuse(const FirstMeshOptions& options) {
  if (options.genus)
    throw Error(ErrorCode::NotConverged, "no grid gives a surface of genus " + std::to_string(*options.genus) +
                                             ": leave the genus open, or give more points");
  throw Error(ErrorCode::NotConverged, "the points do not lie on a surface: they may fill a volume");
}

}  // namespace

FoundContour find_contour(const CloudField& field, const FirstMeshOptions& options, const Progress& progress) {
  constexpr double kUsualBridge = 0.2;
  const double bridge = options.bridge ? *options.bridge / field.samples.size : kUsualBridge;
  const Points places = some_samples(field.samples, kSupportPlaces);
  std::vector<Candidate> candidates =
      fine_contours(field, places, options.genus, bridge, progress_within(progress, 0.0, 0.6));
  Candidate* const fine = most_frequent(candidates, options.genus);
  if (fine == nullptr) refuse(options);
  if (options.faces == FaceKind::Quads && options.pattern == QuadPattern::Grid) {
    FoundContour found = coarse_contour(field, places, fine->shape, options.vertices, bridge);
    if (found.mesh.face_count() > 0) {
      relax_contour(found.mesh, field, kRelaxRounds);
      return found;
    }
  }
  FoundContour found = std::move(fine->contour);
  relax_contour(found.mesh, field, kRelaxRounds);
  coarsen(found.mesh, field, options, progress_within(progress, 0.7, 0.9));
  if (options.faces == FaceKind::Triangles) return found;
  found.mesh = paired_quads(found.mesh);
  for (int round = 0; round < kTurnRounds; ++round) {
    turn_quad_edges(found.mesh);
    relax_contour(found.mesh, field, 1);
  }
  return found;
}

}  // namespace batten
