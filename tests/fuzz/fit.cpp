/// Fuzz target of whole fits: any few points give a finite surface of no more control points than asked for, with the
/// distances that it reports, or an Error with a reason; neither the order of the points nor a callback that stops the
/// fit does harm.
#include <algorithm>

#include "batten/error.h"
#include "batten/fit/fit_surface.h"
#include "fuzz/few_points.h"
#include "fuzz/memory.h"

namespace batten::fuzz {
namespace {

struct FuzzFit {
  PointCloud cloud;
  FitOptions options;
  int cancel_at = 0;  ///< the call of the progress callback that stops; 0: none does
};

FuzzFit decode_fit(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMostTriples = 80;
  Bytes bytes(data, size);
  FuzzFit made;
  const int kind = bytes.take();
  const int more = bytes.take();
  made.options.scheme.kind = (kind & 1) != 0 ? SchemeKind::Loop : SchemeKind::CatmullClark;
  made.options.start = (kind & 2) != 0 ? FitStart::Sphere : FitStart::Auto;
  made.options.creases = (kind & 4) != 0 ? FitCreases::None : FitCreases::Auto;
  made.options.method = (kind & 8) != 0 ? FitMethod::Dynamic : FitMethod::SquaredDistance;
  if ((more & 1) != 0) made.options.genus = bytes.take() % 3;
  if ((more & 2) != 0) made.options.bridge = bytes.take() / 8.0;
  if ((more & 4) != 0) made.options.tolerance = bytes.take() / 64.0;
  if ((more & 8) != 0) made.cancel_at = 1 + bytes.take();
  made.options.rounds = 1 + (more >> 4 & 3);
  made.options.vertices = 8 + bytes.take() % 100;
  made.cloud = few_points(kind, bytes, kMostTriples);
  return made;
}

FitResult fit(const FuzzFit& made, const PointCloud& cloud) {
  int calls = 0;
  return fit_surface(cloud, made.options, [&](double share) {
    require(share >= 0.0 && share <= 1.0, "a progress that is no share");
    return ++calls != made.cancel_at;
  });
}

void check(const FitResult& found, const FuzzFit& made) {
  require(found.mesh.points.allFinite(), "control points that are not finite");
  require(found.topology.vertex_count() == found.mesh.vertex_count(), "a topology of another mesh");
  require(found.distances.size() == made.cloud.points.rows(), "not a distance a point");
  require(found.distances.allFinite() && found.distances.minCoeff() >= 0.0, "distances that are none");
  require(found.report.to_surface.max <= found.distances.maxCoeff(), "a maximum of no point");
  require(found.report.to_surface.rms <= found.report.to_surface.max * (1.0 + 1e-12), "a mean above the maximum");
  require(found.report.outliers < static_cast<Index>(made.cloud.points.rows()), "nothing but outliers");
  for (const FitRound& round : found.report.rounds)
    require(made.options.method == FitMethod::Dynamic || round.after <= round.objective * (1.0 + 1e-9),
            "an objective that rises within a round");
}

void run(const FuzzFit& made) {
  try {
    const FitResult found = fit(made, made.cloud);
    check(found, made);
    const FitResult again = fit(made, reversed(made.cloud));
    require(again.mesh.points == found.mesh.points, "the order of points matters");
    require(again.distances.reverse() == found.distances, "the order of points matters for their distances");
  } catch (const Error& error) {
    require(error.what()[0] != '\0', "an error without words");
  }
}

}  // namespace
}  // namespace batten::fuzz

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  batten::fuzz::run(batten::fuzz::decode_fit(data, size));
  return 0;
}
