/// Fuzz target of everything that computes: a small polygon soup is accepted by Topology or refused with a reason that
/// check() knows; what repair makes of it is accepted; whatever is accepted refines and interpolates in finite numbers.
#include <cmath>

#include "batten/interpolate/interpolator.h"
#include "batten/mesh/check.h"
#include "batten/mesh/repair.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/face_varying.h"
#include "fuzz/memory.h"
#include "fuzz/soup.h"

namespace batten::fuzz {
namespace {

/// Cancels at one of its calls.
Progress canceller(int cancel_at) {
  if (cancel_at == 0) return {};
  return [cancel_at, calls = 0](double done) mutable {
    require(done >= 0.0 && done <= 1.0, "a fraction out of [0, 1]");
    return ++calls != cancel_at;
  };
}

void refine_twice(const Topology& topology, const Scheme& scheme, const Points& points) {
  const RefinedSurface fine = refine(topology, scheme, points, 2);
  require(fine.values.allFinite(), "refined points that are not finite");
  const LimitMatrix limit(fine.topology, scheme.after_first_step());
  require(limit.apply(fine.values).allFinite(), "limit positions that are not finite");
  const LimitNormals normals = limit_normals(topology, scheme, points);
  require(normals.vertices.allFinite() && normals.corners.allFinite(), "normals that are not finite");
}

/// Values at corners with seams here and there, rows that serve several places, and faces without any.
void refine_corners(const Topology& topology, const Scheme& scheme, const Points& points) {
  Attribute attribute{"uv", points, {}};
  for (Index h = 0; h < topology.half_edge_count(); ++h) {
    const Index other = h * 7 % topology.vertex_count();
    attribute.corner_rows.push_back(h % 17 == 16 ? -1 : h % 5 == 4 ? other : topology.origin(h));
  }
  FaceVaryingSurface surface = face_varying_surface(topology, scheme, attribute);
  for (int level = 0; level < 2; ++level) surface = surface.refined();
  require(surface.values.allFinite(), "values at corners that are not finite");
  const LimitMatrix limit(surface.topology, surface.scheme);
  require(limit.apply(surface.values).allFinite(), "limits at corners that are not finite");
}

/// What is reported is measured once more, row by row.
void check_interpolant(const Points& targets, const Interpolant& result) {
  require(result.control.allFinite(), "control points that are not finite");
  const LimitMatrix limit(result.topology, result.scheme);
  const double size = result.control.cwiseAbs().maxCoeff();
  const double missed = (limit.apply(result.control).topRows(targets.rows()) - targets).rowwise().norm().maxCoeff();
  const double diagonal = bounding_diagonal(targets);
  require(result.report.converged() || result.report.max_movement <= 1e6 * diagonal + 1e-12 * size,
          "control points that are nothing but rounding");
  require(std::abs(missed - result.report.max_error) <= 1e-12 * size, "an error that is not the one reported");
}

void interpolate_all_ways(const Topology& topology, const Scheme& scheme, const Points& targets, int cancel_at) {
  for (const OnSingular choice : {OnSingular::Alpha, OnSingular::LeastSquares, OnSingular::Refuse}) {
    InterpolateOptions options;
    options.on_singular = choice;
    options.max_iterations = 300;
    try {
      const Interpolator interpolator(topology, scheme, options, canceller(cancel_at));
      check_interpolant(targets, interpolator.solve(targets, canceller(cancel_at)));
    } catch (const Error& error) {
      const bool expected = error.code() == ErrorCode::SingularSystem || error.code() == ErrorCode::Cancelled;
      require(expected, error.what());
    }
  }
}

void exercise(const Mesh& mesh, const Soup& soup) {
  const Topology topology(mesh);
  Scheme scheme = choose_scheme(mesh);
  scheme.alpha = soup.alpha;
  if (mesh.vertex_count() == 0) return;
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    if (kind == SchemeKind::Loop && !all_triangles(mesh)) continue;
    scheme.kind = kind;
    refine_twice(topology, scheme, mesh.points);
    refine_corners(topology, scheme, mesh.points);
    interpolate_all_ways(topology, scheme, mesh.points, soup.cancel_at);
  }
}

bool accepted(const Mesh& mesh) {
  try {
    const Topology topology(mesh);
    require(check(mesh).empty(), "Topology accepts what check() complains of");
    return true;
  } catch (const Error& error) {
    require(!check(mesh).empty(), "Topology refuses what check() finds nothing wrong with");
    return false;
  }
}

void run(const Soup& soup) {
  const bool good = accepted(soup.mesh);
  if (good) exercise(soup.mesh, soup);
  const RepairResult repaired = repair(soup.mesh);
  require(accepted(repaired.mesh), "a repaired mesh that Topology refuses");
  require(repair(repaired.mesh).changes.empty(), "a repaired mesh that is repaired again");
  if (!good) exercise(repaired.mesh, soup);
  const Mesh triangles = triangulated(repaired.mesh);
  if (accepted(triangles)) exercise(triangles, soup);
}

}  // namespace
}  // namespace batten::fuzz

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  batten::fuzz::run(batten::fuzz::decode_soup(data, size));
  return 0;
}
