#include "batten/dynamics/supports.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "batten/dynamics/force.h"
#include "batten/error.h"
#include "batten/refine/refined_rows.h"
#include "batten/refine/refinement.h"

namespace batten {

PointPath straight_path(std::vector<double> times, std::vector<Eigen::Vector3d> points) {
  if (times.empty() || times.size() != points.size()) {
    throw Error(ErrorCode::BadShape, "a path has a point for each time, and at least one; it has " +
                                         std::to_string(times.size()) + " times and " + std::to_string(points.size()) +
                                         " points");
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || !points[i].allFinite()) {
      throw Error(ErrorCode::NotFinite, "entry " + std::to_string(i) + " of a path is not finite");
    }
    if (i > 0 && !(times[i] > times[i - 1])) {
      throw Error(ErrorCode::BadArgument, "the times of a path increase, but entry " + std::to_string(i) + " does not");
    }
  }
  return [times = std::move(times), points = std::move(points)](double time) -> Eigen::Vector3d {
    const auto next = std::upper_bound(times.begin(), times.end(), time);
    if (next == times.begin()) return points.front();
    if (next == times.end()) return points.back();
    const auto i = static_cast<std::size_t>(next - times.begin());
    const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
    return (1.0 - share) * points[i - 1] + share * points[i];
  };
}

Supports hold_boundary(const ElasticSurface& surface) {
  Supports supports;
  const Topology& topology = surface.topology();
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v) || !topology.is_boundary_vertex(v)) continue;
    supports.points.push_back({v, stay_at(surface.rest().row(v).transpose())});
  }
  return supports;
}

namespace {

Supports::Pin refined_pin(const SurfacePatches& patches, const Supports::Pin& pin) {
  Supports::Pin result{place_on_refined(patches, pin.place), pin.path, pin.part};
  if (pin.part == JetPart::Point) return result;
  // Where the base is a first refinement, the parameters stay (place_on_refined()).
  if (patches.has_first_step()) return result;
  if (!patches.quads()) {
    throw Error(ErrorCode::BadArgument,
                "a derivative is pinned in a triangle, of whose smaller triangles none has both of its directions; "
                "refine the body first, then pin derivatives");
  }
  const Eigen::Matrix2d change = refined_parameters(patches.base(), pin.place);
  // d/du = change(0, 0) d/da + change(1, 0) d/db, where one of the two is 0.
  const int of_u = change(0, 0) != 0.0 ? 0 : 1;
  const double by_u = change(of_u, 0);
  const double by_v = change(1 - of_u, 1);
  constexpr JetPart kFirst[] = {JetPart::Du, JetPart::Dv};
  constexpr JetPart kSecond[] = {JetPart::Duu, JetPart::Dvv};
  double factor = 1.0;
  switch (pin.part) {
    case JetPart::Du:
      result.part = kFirst[of_u];
      factor = by_u;
      break;
    case JetPart::Dv:
      result.part = kFirst[1 - of_u];
      factor = by_v;
      break;
    case JetPart::Duu:
      result.part = kSecond[of_u];
      factor = by_u * by_u;
      break;
    case JetPart::Dvv:
      result.part = kSecond[1 - of_u];
      factor = by_v * by_v;
      break;
    case JetPart::Duv:
      factor = by_u * by_v;
      break;
    case JetPart::Point:
      break;
  }
  result.path = [path = pin.path, factor](double time) -> Eigen::Vector3d { return path(time) / factor; };
  return result;
}

/// The vertex on the surface, moving as its control point does.
Supports::Pin pin_of_vertex(const ElasticSurface& body, const Supports::FixedPoint& point, const ElasticState& state) {
  const SurfacePatches& patches = body.patches();
  const SurfacePlace place = place_of_vertex(patches.base(), point.vertex);
  Values at = SurfaceWeights(patches).rows({&place, 1}) * state.positions;
  const Eigen::Vector3d offset = at.row(0).transpose() - point.path(state.time);
  const PointPath path = [offset, lead = point.path](double time) -> Eigen::Vector3d { return offset + lead(time); };
  return {place_on_refined(patches, place), path, JetPart::Point};
}

}  // namespace

Supports refined_supports(const ElasticSurface& body, const Supports& supports, const ElasticState& state) {
  const SurfacePatches& patches = body.patches();
  Supports result;
  for (const Supports::Pin& pin : supports.pins) result.pins.push_back(refined_pin(patches, pin));
  if (supports.points.empty()) return result;
  std::map<Index, std::size_t> fixed;  // by vertex
  for (std::size_t i = 0; i < supports.points.size(); ++i) fixed[supports.points[i].vertex] = i;
  const SparseRows rows = refined_rows(with_surface_holes(body.topology(), patches.scheme()), patches.scheme());
  std::vector<bool> leads(supports.points.size(), false);
  for (Index r = 0; r < rows.count(); ++r) {
    std::vector<std::pair<double, PointPath>> sum;
    bool all = true;
    for (Index e = rows.starts[r]; all && e < rows.starts[r + 1]; ++e) {
      const auto found = fixed.find(rows.columns[e]);
      all = found != fixed.end();
      if (all) sum.emplace_back(rows.weights[e], supports.points[found->second].path);
    }
    if (!all || sum.empty()) continue;
    for (Index e = rows.starts[r]; e < rows.starts[r + 1]; ++e) leads[fixed[rows.columns[e]]] = true;
    result.points.push_back({r, [sum = std::move(sum)](double time) -> Eigen::Vector3d {
                               Eigen::Vector3d point = Eigen::Vector3d::Zero();
                               for (const auto& [weight, path] : sum) point += weight * path(time);
                               return point;
                             }});
  }
  for (std::size_t i = 0; i < leads.size(); ++i) {
    if (!leads[i] && !body.topology().is_isolated(supports.points[i].vertex)) {
      result.pins.push_back(pin_of_vertex(body, supports.points[i], state));
    }
  }
  return result;
}

}  // namespace batten
