#include "batten/limit/limit_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "batten/error.h"
#include "batten/limit/piece_grid.h"
#include "batten/limit/spline_jet.h"
#include "batten/limit/vertex_limit.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/ring_steps.h"

namespace batten {

namespace {

/// After so many levels irregular faces are the ones around single vertices, whose kinds are few.
constexpr int kLevels = 2;
/// A double has no smaller fractions of a face: here is the vertex itself.
constexpr int kMostHalvings = 53;

using Points3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// One of four children, and the place in it. A triangle's middle child is turned: its parameters run backwards.
struct Step {
  int child;
  bool turned;
};
Step halve(bool quads, double& u, double& v) {
  if (quads) {
    u *= 2.0;
    v *= 2.0;
    const bool right = u >= 1.0;
    const bool up = v >= 1.0;
    if (right) u -= 1.0;
    if (up) v -= 1.0;
    return {right ? (up ? 2 : 1) : (up ? 3 : 0), false};
  }
  const double w = 1.0 - u - v;
  if (u >= 0.5) {
    u = 2.0 * u - 1.0;
    v = 2.0 * v;
    return {1, false};
  }
  if (v >= 0.5) {
    u = 2.0 * u;
    v = 2.0 * v - 1.0;
    return {2, false};
  }
  u *= 2.0;
  v *= 2.0;
  if (w >= 0.5) return {0, false};
  u = 1.0 - u;
  v = 1.0 - v;
  return {3, true};
}

/// The derivatives of the jet in a child's parameters become those in the parent's: `scale` is +-2^halvings.
void chain(double scale, Jet& jet) {
  jet.du *= scale;
  jet.dv *= scale;
  jet.duu *= scale * scale;
  jet.duv *= scale * scale;
  jet.dvv *= scale * scale;
}

/// Scratch memory of one query.
struct Workspace {
  Points3 ring;
  Points3 next;
};

}  // namespace

struct LimitSurface::Parts {
  const Topology& control_topology;
  Scheme scheme;
  std::unique_ptr<Refinement> first;
  Pieces pieces;
  RingSteps steps;
  Buffer<Index> kinds;  ///< of each configuration of the pieces
  Values base_values;
  std::unique_ptr<LevelValues> values;

  Parts(const Topology& topology, const Scheme& scheme_in)
      : control_topology(topology),
        scheme(scheme_in),
        first(needs_first_step(topology, scheme_in) ? std::make_unique<Refinement>(topology, scheme_in) : nullptr),
        pieces(first == nullptr ? topology : first->child(), scheme_in.after_first_step(), kLevels,
               Pieces::Rest::Rings),
        steps(scheme_in) {
    FaceRing ring;
    for (const Pieces::Configuration& configuration : pieces.configurations()) {
      ring.gather(configuration.topology, pieces.scheme(), 0);
      kinds.push_back(steps.kind_of(configuration.topology, ring));
    }
  }

  const Topology& base() const { return pieces.topology(0); }
  bool quads() const { return scheme.kind == SchemeKind::CatmullClark; }

  void set_control(ConstValuesRef control) {
    require_vertex_rows(control_topology, control);
    if (control.cols() != 3) throw Error(ErrorCode::BadShape, "a limit surface has points of three columns");
    base_values = first == nullptr ? Values(control) : first->apply(control);
    values = std::make_unique<LevelValues>(pieces, base_values);
  }

  void check(const SurfacePlace& place) const {
    if (place.face < 0 || place.face >= base().face_count()) {
      throw Error(ErrorCode::IndexOutOfRange, "face " + std::to_string(place.face) + " does not exist; the base has " +
                                                  std::to_string(base().face_count()) + " faces");
    }
    const double most = quads() ? 1.0 : 1.0 - place.v;
    if (place.u >= 0.0 && place.v >= 0.0 && place.u <= most && place.v <= 1.0) return;
    throw Error(ErrorCode::BadArgument,
                "(u, v) = (" + std::to_string(place.u) + ", " + std::to_string(place.v) + ") is not in the face");
  }

  /// The piece that a place lies in; (u, v) become its own parameters.
  const Piece& locate(const SurfacePlace& place, double& u, double& v) const {
    const Piece* piece = pieces.begin(place.face);
    u = place.u;
    v = place.v;
    if (piece->level == 0) return *piece;
    const double steps_per_side = 1 << kLevels;
    const double x = place.u * steps_per_side;
    const double y = place.v * steps_per_side;
    // Rounding on a line between triangles may leave a place outside all of them: the nearest one will do.
    const Piece* nearest = piece;
    double least_outside = std::numeric_limits<double>::infinity();
    for (; piece != pieces.end(place.face); ++piece) {
      const double along = (piece->turned ? piece->x - x : x - piece->x) / piece->size;
      const double across = (piece->turned ? piece->y - y : y - piece->y) / piece->size;
      const double beyond = quads() ? std::max(along, across) - 1.0 : along + across - 1.0;
      const double outside = std::max({-along, -across, beyond, 0.0});
      if (outside >= least_outside) continue;
      least_outside = outside;
      nearest = piece;
      u = along;
      v = across;
      if (outside == 0.0) break;
    }
    u = std::clamp(u, 0.0, 1.0);
    v = std::clamp(v, 0.0, quads() ? 1.0 : 1.0 - u);
    return *nearest;
  }

  Jet jet(const SurfacePlace& place, Workspace& work) const;
  Jet patch_jet(double u, double v, const Points3& points) const;
  Jet ring_jet(Index kind, const Piece& piece, double u, double v, Workspace& work) const;
  Jet vertex_jet(const Piece& piece, double u, double v) const;
};

Jet LimitSurface::Parts::patch_jet(double u, double v, const Points3& points) const {
  JetWeights weights;
  const int count = quads() ? 16 : kTrianglePatchSize;
  if (quads()) {
    quad_jet_weights(u, v, weights);
  } else {
    triangle_jet_weights(u, v, weights);
  }
  const auto sum = [&](const std::array<double, 16>& row) {
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    for (int i = 0; i < count; ++i) total += row[i] * points.row(i).transpose();
    return total;
  };
  return {sum(weights.value), sum(weights.du), sum(weights.dv), sum(weights.duu), sum(weights.duv), sum(weights.dvv)};
}

/// Halves the face until it is regular. Sums run around the first point of the ring, which comes along, so that small
/// rings keep their digits.
Jet LimitSurface::Parts::ring_jet(Index kind, const Piece& piece, double u, double v, Workspace& work) const {
  Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
  double scale = 1.0;
  const double first_u = u;
  const double first_v = v;
  for (int halvings = 0; halvings < kMostHalvings; ++halvings) {
    const Step step = halve(quads(), u, v);
    scale *= step.turned ? -2.0 : 2.0;
    const RingSteps::Child& child = steps.child(kind, step.child);
    const Eigen::RowVector3d centre = work.ring.row(0);
    origin += centre;
    work.next.resize(child.rows.count(), 3);
    for (Index r = 0; r < child.rows.count(); ++r) {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (Index e = child.rows.starts[r]; e < child.rows.starts[r + 1]; ++e) {
        sum += child.rows.weights[e] * (work.ring.row(child.rows.columns[e]) - centre);
      }
      work.next.row(r) = sum;
    }
    std::swap(work.ring, work.next);
    kind = child.kind;
    if (kind != RingSteps::kPatch) continue;
    if (quads()) {
      complete_quad_patch(child.patch.rows.data(), work.ring.data(), 3);
    } else {
      complete_triangle_patch(child.patch.rows.data(), work.ring.data(), 3);
    }
    Jet jet = patch_jet(u, v, work.ring);
    jet.point += origin.transpose();
    chain(scale, jet);
    return jet;
  }
  return vertex_jet(piece, first_u, first_v);
}

/// At the corner of the piece that the place is.
Jet LimitSurface::Parts::vertex_jet(const Piece& piece, double u, double v) const {
  const Topology& topology = pieces.topology(piece.level);
  ConstValuesRef level_values = values->at(piece.level);
  Index half_edge = piece.half_edge;
  const int corner = quads() ? (u < 0.5 ? (v < 0.5 ? 0 : 3) : (v < 0.5 ? 1 : 2)) : (u > 0.5 ? 1 : v > 0.5 ? 2 : 0);
  for (int c = 0; c < corner; ++c) half_edge = topology.next(half_edge);
  const auto sum = [&](TileValue value) {
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    visit_vertex_limit(topology, pieces.scheme(), value, half_edge,
                       [&](Index vertex, double weight) { total += weight * level_values.row(vertex).transpose(); });
    return total;
  };
  Jet jet;
  jet.point = sum(TileValue::Limit);
  jet.du = sum(TileValue::TangentU);
  jet.dv = sum(TileValue::TangentV);
  jet.duu = jet.duv = jet.dvv = Eigen::Vector3d::Zero();
  jet.regular = false;
  return jet;
}

Jet LimitSurface::Parts::jet(const SurfacePlace& place, Workspace& work) const {
  double u = 0.0;
  double v = 0.0;
  const Piece& piece = locate(place, u, v);
  const bool is_patch = piece.kind == Piece::Kind::Patch;
  const Index kind = is_patch ? RingSteps::kPatch : kinds[piece.configuration];
  const Index count = is_patch ? (quads() ? 16 : kTrianglePatchSize)
                               : pieces.configurations()[piece.configuration].topology.vertex_count();
  const Index* rows = pieces.rows(piece);
  ConstValuesRef level_values = values->at(piece.level);
  work.ring.resize(count, 3);
  bool complete = true;
  for (Index i = 0; i < count; ++i) {
    if (rows[i] == RegularPatch::kMissing) {
      complete = false;
    } else {
      work.ring.row(i) = level_values.row(rows[i]);
    }
  }
  Jet jet;
  if (is_patch) {
    if (!complete) {
      if (quads()) {
        complete_quad_patch(rows, work.ring.data(), 3);
      } else {
        complete_triangle_patch(rows, work.ring.data(), 3);
      }
    }
    jet = patch_jet(u, v, work.ring);
  } else {
    jet = ring_jet(kind, piece, u, v, work);
  }
  const double size = static_cast<double>(1 << kLevels) / piece.size;
  if (jet.regular) chain(piece.turned ? -size : size, jet);
  return jet;
}

LimitSurface::LimitSurface(const Topology& topology, const Scheme& scheme, ConstValuesRef control) {
  parts_ = std::make_unique<Parts>(topology, scheme);
  parts_->set_control(control);
}

LimitSurface::~LimitSurface() = default;
LimitSurface::LimitSurface(LimitSurface&&) noexcept = default;

const Topology& LimitSurface::base() const { return parts_->base(); }
void LimitSurface::set_control(ConstValuesRef control) { parts_->set_control(control); }

Jet LimitSurface::jet(const SurfacePlace& place) const {
  parts_->check(place);
  Workspace work;
  return parts_->jet(place, work);
}

void LimitSurface::jets(std::span<const SurfacePlace> places, std::span<Jet> jets) const {
  if (places.size() != jets.size()) {
    throw Error(ErrorCode::BadShape,
                std::to_string(places.size()) + " places ask for as many jets, not " + std::to_string(jets.size()));
  }
  for (const SurfacePlace& place : places) parts_->check(place);
  parallel_for(
      static_cast<std::ptrdiff_t>(places.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Workspace work;
        for (std::ptrdiff_t i = begin; i < end; ++i) jets[i] = parts_->jet(places[i], work);
      },
      256);
}

PointCurvature curvature_of(const Jet& jet) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  PointCurvature result;
  const Eigen::Vector3d cross = jet.du.cross(jet.dv);
  const double length = cross.norm();
  result.normal = length > 0.0 ? Eigen::Vector3d(cross / length) : Eigen::Vector3d::Zero();
  result.mean = result.gaussian = result.greatest = result.least = kNone;
  result.greatest_direction.setConstant(kNone);
  result.least_direction.setConstant(kNone);
  if (!jet.regular || !(length > 0.0)) return result;
  const double e = jet.du.dot(jet.du);
  const double f = jet.du.dot(jet.dv);
  const double g = jet.dv.dot(jet.dv);
  const double area = length * length;
  // The second form with its sign turned: a sphere's outward normal points away from where it bends to.
  const double l = -jet.duu.dot(result.normal);
  const double m = -jet.duv.dot(result.normal);
  const double n = -jet.dvv.dot(result.normal);
  result.gaussian = (l * n - m * m) / area;
  result.mean = 0.5 * (e * n - 2.0 * f * m + g * l) / area;
  // In an orthonormal frame of the tangent plane the shape operator is symmetric.
  const double a = std::sqrt(e);
  const double b = f / a;
  const double c = length / a;
  const double s11 = l / e;
  const double s12 = (m - b / a * l) / (a * c);
  const double s22 = (n - 2.0 * b / a * m + b * b / e * l) / (c * c);
  const double spread = std::hypot(0.5 * (s11 - s22), s12);
  result.greatest = result.mean + spread;
  result.least = result.mean - spread;
  const double angle = 0.5 * std::atan2(s12, 0.5 * (s11 - s22));
  const Eigen::Vector3d x = jet.du / a;
  const Eigen::Vector3d y = result.normal.cross(x);
  result.greatest_direction = std::cos(angle) * x + std::sin(angle) * y;
  result.least_direction = result.normal.cross(result.greatest_direction);
  return result;
}

}  // namespace batten
