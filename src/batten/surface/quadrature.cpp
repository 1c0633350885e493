#include "batten/surface/quadrature.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/corner_parameters.h"
#include "batten/patch/face_types.h"

namespace batten {

namespace {

struct Rule {
  std::vector<double> places;
  std::vector<double> weights;
};

/// Gauss and Legendre's rule on [0, 1], from the eigenvectors of the polynomials' recurrence (Golub and Welsch 1969).
Rule gauss_rule(int points) {
  Eigen::MatrixXd recurrence = Eigen::MatrixXd::Zero(points, points);
  for (int k = 1; k < points; ++k) {
    recurrence(k, k - 1) = recurrence(k - 1, k) = k / std::sqrt(4.0 * k * k - 1.0);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(recurrence);
  Rule rule;
  for (int k = 0; k < points; ++k) {
    rule.places.push_back(0.5 + 0.5 * solver.eigenvalues()[k]);
    rule.weights.push_back(solver.eigenvectors()(0, k) * solver.eigenvectors()(0, k));
  }
  return rule;
}

/// A part of a face: (u, v) of its own is at (u0 + size u, v0 + size v) of the face; size < 0 where it is turned.
struct Cell {
  double u0 = 0.0;
  double v0 = 0.0;
  double size = 1.0;

  /// In RingTypes' order.
  Cell child(bool quads, int number) const {
    const double half = 0.5 * size;
    if (!quads && number == 3) return {u0 + half, v0 + half, -half};
    const std::array<double, 2> corner = corner_parameters(quads ? 4 : 3, number);
    return {u0 + half * corner[0], v0 + half * corner[1], half};
  }
};

class Filler {
 public:
  Filler(bool quads, const RingTypes& types, const QuadratureOptions& options, SurfaceQuadrature& quadrature)
      : types_(types),
        quads_(quads),
        levels_(options.levels),
        rule_(gauss_rule(options.points)),
        quadrature_(quadrature) {}

  /// Halves towards what is irregular.
  void add(Index face, Index type, const Cell& cell, int level) {
    if (type == RingTypes::kPatch || level == levels_) return add_points(face, cell);
    for (int c = 0; c < 4; ++c) add(face, types_.child(type, c).type, cell.child(quads_, c), level + 1);
  }

 private:
  /// On a triangle the square's rule is drawn together at the third corner: v shrinks by 1 - u.
  void add_points(Index face, const Cell& cell) {
    const double area = cell.size * cell.size;
    for (std::size_t i = 0; i < rule_.places.size(); ++i) {
      const double u = rule_.places[i];
      const double width = quads_ ? 1.0 : 1.0 - u;
      for (std::size_t j = 0; j < rule_.places.size(); ++j) {
        const double v = width * rule_.places[j];
        quadrature_.places.push_back({face, cell.u0 + cell.size * u, cell.v0 + cell.size * v});
        quadrature_.weights.push_back(area * width * rule_.weights[i] * rule_.weights[j]);
      }
    }
  }

  const RingTypes& types_;
  bool quads_;
  int levels_;
  Rule rule_;
  SurfaceQuadrature& quadrature_;
};

void require_in_range(const std::string& name, int number, int least, int most) {
  if (number >= least && number <= most) return;
  throw Error(ErrorCode::BadArgument, "a quadrature has " + std::to_string(least) + " to " + std::to_string(most) +
                                          " " + name + ", not " + std::to_string(number));
}

void require_in_range(const QuadratureOptions& options) {
  require_in_range("points along a side", options.points, 1, 16);
  require_in_range("levels", options.levels, 0, 40);
}

}  // namespace

SurfaceQuadrature surface_quadrature(const SurfacePatches& patches, const QuadratureOptions& options) {
  require_in_range(options);
  const FaceTypes& types = patches.face_types();
  SurfaceQuadrature quadrature;
  Filler filler(patches.quads(), types.ring_types(), options, quadrature);
  quadrature.starts.push_back(0);
  for (Index f = 0; f < patches.base().face_count(); ++f) {
    if (patches.holes().empty() || patches.holes()[f] == 0) filler.add(f, types.type(f), {}, 0);
    quadrature.starts.push_back(quadrature.places.size());
  }
  return quadrature;
}

SurfaceQuadrature face_quadrature(bool quads, const RingTypes& types, Index type, const QuadratureOptions& options) {
  require_in_range(options);
  SurfaceQuadrature quadrature;
  Filler(quads, types, options, quadrature).add(0, type, {}, 0);
  quadrature.starts = {0, quadrature.places.size()};
  return quadrature;
}

Scalars area_weights(const LimitSurface& surface, const SurfaceQuadrature& quadrature) {
  std::vector<Jet> jets(quadrature.places.size());
  surface.jets(quadrature.places, jets);
  Scalars weights(static_cast<Eigen::Index>(jets.size()));
  parallel_for(weights.size(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      weights[i] = quadrature.weights[i] * jets[i].du.cross(jets[i].dv).norm();
  });
  return weights;
}

}  // namespace batten
