#include "batten/expand/scheme_comparison.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "batten/error.h"
#include "batten/interpolate/fair_interpolation.h"
#include "batten/interpolate/interpolator.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/unit_scale.h"
#include "batten/progress.h"
#include "batten/refine/refinement.h"

namespace batten {

namespace {

struct ComparedScheme {
  const char* name;
  SchemeKind kind;
  bool fair;
};
constexpr std::array<ComparedScheme, 5> kComparedSchemes{
    {{"Butterfly", SchemeKind::Butterfly, false},
     {"Modified Butterfly", SchemeKind::ModifiedButterfly, false},
     {"interpolated Loop", SchemeKind::Loop, false},
     {"fair Loop", SchemeKind::Loop, true},
     {"interpolated Catmull-Clark", SchemeKind::CatmullClark, false}}};

/// Control points of a surface, refined so often already.
struct ComparedControl {
  RefinedSurface surface;
  Scheme scheme;
  int levels = 0;
};

/// The surface through the points.
ComparedControl through_points(const Topology& topology, ConstValuesRef points, ComparedSurface& compared,
                               const Progress& progress) {
  const Interpolator interpolator(topology, compared.scheme, {}, progress_within(progress, 0.0, 0.3));
  Interpolant plain = interpolator.solve(points, progress_within(progress, 0.3, 1.0));
  compared.method = plain.report.solve.method_name;
  compared.iterations = plain.report.solve.iterations;
  compared.max_error = plain.report.max_error;
  if (!plain.report.converged()) {
    std::ostringstream what;
    what.precision(2);
    what << "not solved: it still misses vertices by " << compared.max_error << " after " << compared.iterations
         << " iterations";
    throw Error(ErrorCode::NotConverged, what.str());
  }
  const int levels = plain.topology.vertex_count() > topology.vertex_count() ? 1 : 0;
  return {{plain.topology, std::move(plain.control)}, plain.scheme, levels};
}

/// The fairest one.
ComparedControl fair_through_points(const Topology& topology, ConstValuesRef points, ComparedSurface& compared,
                                    const Progress& progress) {
  FairInterpolant fair = interpolate_fairly(topology, compared.scheme, points, {}, progress);
  compared.method = "fair, " + fair.report.solve.method_name;
  compared.iterations = fair.report.solve.iterations;
  compared.max_error = fair.report.max_error;
  return {{fair.topology, std::move(fair.control)}, fair.scheme, fair.report.levels};
}

void build(const Topology& topology, ConstValuesRef points, int levels, bool fair, ComparedSurface& compared,
           const Progress& progress) {
  constexpr double kSolved = 0.4;  // of the time
  constexpr double kRefined = 0.7;
  constexpr double kMoved = 0.8;
  constexpr double kCurved = 0.9;
  RefinedSurface surface{with_surface_holes(topology, compared.scheme), Values()};
  Scheme scheme = compared.scheme;
  int steps = levels;
  if (is_interpolating(scheme.kind)) {
    surface.values = points;
  } else {
    const Progress solving = progress_within(progress, 0.0, kSolved);
    ComparedControl control = fair ? fair_through_points(topology, points, compared, solving)
                                   : through_points(topology, points, compared, solving);
    if (control.levels > 0) surface.topology = control.surface.topology;
    surface.values = std::move(control.surface.values);
    steps = std::max(0, levels - control.levels);
    scheme = control.scheme;
  }
  surface = refine(surface.topology, scheme, surface.values, steps, progress_within(progress, kSolved, kRefined));
  if (steps > 0) scheme = scheme.after_first_step();
  const LimitMatrix limit(surface.topology, scheme);
  compared.mesh = mesh_from_topology(surface.topology);
  compared.mesh.points = limit.apply(surface.values, progress_within(progress, kRefined, kMoved));
  DiscreteCurvature curvature =
      discrete_curvature(surface.topology, compared.mesh.points, progress_within(progress, kMoved, kCurved));
  compared.fairness =
      fairness(surface.topology, compared.mesh.points, curvature, progress_within(progress, kCurved, 1.0));
  compared.mean = std::move(curvature.mean);
}

/// From the scale that it was measured at back to the mesh's unit; fairness but for the area has none.
void rescale(double scale, ComparedSurface& compared) {
  if (scale == 1.0) return;
  compared.max_error /= scale;
  compared.mesh.points /= scale;
  compared.mean *= scale;
  compared.fairness.area = compared.fairness.area / scale / scale;
}

}  // namespace

std::vector<ComparedSurface> compare_schemes(const Topology& topology, const Scheme& scheme, ConstValuesRef points,
                                             int levels, const Progress& progress) {
  require_vertex_rows(topology, points);
  if (topology.uniform_face_size() != 3) {
    throw Error(ErrorCode::NotTriangles, "the schemes to compare have triangles in common only; split the faces first");
  }
  const double scale = unit_scale(points);
  const Values scaled = scale * points;
  std::vector<ComparedSurface> all;
  for (const ComparedScheme& contestant : kComparedSchemes) {
    ComparedSurface compared;
    compared.name = contestant.name;
    compared.scheme = scheme;
    compared.scheme.kind = contestant.kind;
    const double share = 1.0 / static_cast<double>(kComparedSchemes.size());
    const double begin = share * static_cast<double>(all.size());
    try {
      build(topology, scaled, levels, contestant.fair, compared, progress_within(progress, begin, begin + share));
    } catch (const Error& error) {
      if (error.code() == ErrorCode::Cancelled) throw;
      compared.failure = error.what();
    }
    rescale(scale, compared);
    all.push_back(std::move(compared));
  }
  return all;
}

}  // namespace batten
