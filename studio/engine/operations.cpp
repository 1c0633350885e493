#include "studio/engine/operations.h"

#include <algorithm>

#include "batten/expand/bands.h"
#include "batten/expand/denoise.h"
#include "batten/expand/morph_surface.h"
#include "batten/fit/fit_surface.h"
#include "batten/fit/mesh_samples.h"
#include "batten/fit/surface_film.h"
#include "batten/interpolate/method_comparison.h"
#include "batten/io/animation.h"
#include "batten/mesh/moved_mesh.h"
#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/tessellate/surface_mesh.h"
#include "studio/engine/surface.h"

namespace batten::studio {
namespace {

Scheme scheme_of(const val& wishes) {
  Scheme scheme;
  scheme.kind = static_cast<SchemeKind>(wishes["scheme"].as<int>());
  scheme.boundary = static_cast<BoundaryRule>(wishes["boundary"].as<int>());
  return scheme;
}

/// A round of a fit as the page draws it.
val drawing_of(const SurfaceFrame& frame, UpAxis up) {
  SurfaceWishes plain;
  plain.scheme = frame.scheme;
  plain.interpolated = false;
  return Surface(std::make_shared<MeshFile>(frame_mesh(frame), up), plain, {}).drawing();
}

}  // namespace

val denoised_points(const std::shared_ptr<MeshFile>& file, const val& wishes, int m, int passes, const val& report) {
  return guarded([&] {
    DenoiseOptions options;
    options.m = m;
    options.passes = passes;
    const DenoiseResult denoised = denoise(file->mesh(), scheme_of(wishes), options, progress_of(report));
    val result = val::object();
    result.set("points", typed_array(denoised.points));
    result.set("removed", denoised.removed);
    return result;
  });
}

val banded_points(const std::shared_ptr<MeshFile>& file, const val& wishes, const val& gains) {
  return guarded([&] {
    const Scheme scheme = scheme_of(wishes);
    const std::vector<double> factors = emscripten::convertJSArrayToNumberVector<double>(gains);
    const std::vector<Band> bands = octave_bands(scheme.kind, SeriesMatrix::Limit, static_cast<int>(factors.size()));
    const MeshSeries series(Topology(file->mesh()), scheme);
    const Equalized equalized = equalize(series, file->mesh().points, bands, factors);
    val result = val::object();
    result.set("points", typed_array(equalized.values));
    result.set("energies", typed_array(equalized.energies));
    return result;
  });
}

ShapeMorph::ShapeMorph(const MeshFile& from, const Mesh& to, const Scheme& scheme)
    : from_(from.mesh()),
      up_(from.up()),
      topology_(from_),
      scheme_(scheme),
      morph_(MeshSeries(topology_, scheme_), from_.points, (require_same_connectivity(from_, to), to.points)) {}

val ShapeMorph::at(double t) const {
  return guarded([&] { return typed_array(morph_.at(t)); });
}

val ShapeMorph::film(const std::string& path, double seconds, const val& report) const {
  return guarded([&] {
    constexpr double kRefined = 0.7;
    constexpr int kFrames = 24;  // as the tool
    const Progress progress = progress_of(report);
    const MovingSurface surface =
        morph_surface(topology_, scheme_, from_, morph_, std::min(3, picture_levels(topology_)), kFrames, seconds,
                      progress_within(progress, 0.0, kRefined));
    WriteOptions options;
    options.up = up_;
    write_animation(path, surface.mesh, surface.targets, options, progress_within(progress, kRefined, 1.0));
    return val::null();
  });
}

val make_morph(const std::shared_ptr<MeshFile>& from, const std::shared_ptr<MeshFile>& to, const val& wishes) {
  return guarded([&] { return val(std::make_shared<ShapeMorph>(*from, to->mesh(), scheme_of(wishes))); });
}

val compared_methods(const std::shared_ptr<MeshFile>& file, const val& wishes, const val& report) {
  return guarded([&] {
    const std::vector<MethodResult> methods =
        compare_methods(Topology(file->mesh()), scheme_of(wishes), {}, file->mesh().points, progress_of(report));
    return list(methods, [](const MethodResult& method) {
      val one = val::object();
      one.set("name", method.name);
      one.set("failure", method.failure);
      one.set("iterations", method.report.iterations);
      one.set("seconds", method.solve_seconds);
      one.set("maxError", method.max_error);
      one.set("residuals", typed_array(method.report.residual_history));
      one.set("measuredAfter", typed_array(method.report.measured_after));
      return one;
    });
  });
}

val fitted(const std::shared_ptr<MeshFile>& points, const std::shared_ptr<MeshFile>& cage, int vertices,
           double tolerance, const val& report, const val& watch) {
  return guarded([&] {
    FitOptions options;
    options.tolerance = tolerance;
    if (cage) {
      options.initial = cage->mesh();
      options.scheme.kind = choose_scheme(cage->mesh()).kind;
    } else {
      options.vertices = vertices;
    }
    if (!watch.isNull()) options.watch = [&](const SurfaceFrame& frame) { watch(drawing_of(frame, points->up())); };
    const Index control_points = cage ? cage->mesh().vertex_count() : static_cast<Index>(vertices);
    FitResult fit = fit_surface(cloud_of_mesh(points->mesh(), control_points), options, progress_of(report));
    val result = val::object();
    result.set("rms", fit.report.to_surface.rms);
    result.set("max", fit.report.to_surface.max);
    result.set("outliers", fit.report.outliers);
    result.set("rounds", list(fit.report.rounds, [](const FitRound& round) {
                 val one = val::object();
                 one.set("vertices", round.vertices);
                 one.set("rms", round.rms);
                 one.set("max", round.max);
                 return one;
               }));
    result.set("mesh", std::make_shared<MeshFile>(std::move(fit.mesh), points->up()));
    return result;
  });
}

}  // namespace batten::studio
