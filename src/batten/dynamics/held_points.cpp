#include "batten/dynamics/held_points.h"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <string>

#include "batten/error.h"
#include "batten/surface/surface_weights.h"

namespace batten {

namespace {

/// The rows of all pins, whatever part of the jet each holds.
PlaceRows pin_rows(const ElasticSurface& surface, const std::vector<Supports::Pin>& pins) {
  PlaceRows result;
  result.rows.resize(static_cast<Eigen::Index>(pins.size()), surface.rest().rows());
  if (!pins.empty()) {
    const SurfaceWeights weights(surface.patches());
    for (std::size_t i = 0; i < pins.size(); ++i) {
      const PlaceRows::Matrix row = weights.rows({&pins[i].place, 1}, pins[i].part);
      if (row.nonZeros() == 0) {
        throw Error(ErrorCode::BadArgument, "pin " + std::to_string(i) +
                                                " holds a derivative that does not exist at its place; move it off the "
                                                "vertex");
      }
      for (PlaceRows::Matrix::InnerIterator e(row, 0); e; ++e) {
        result.rows.insert(static_cast<Eigen::Index>(i), e.col()) = e.value();
      }
    }
  }
  result.rows.makeCompressed();
  result.transposed = result.rows.transpose();
  return result;
}

Eigen::RowVector3d finite_place(const PointPath& path, double time, const std::string& support) {
  const Eigen::Vector3d place = path(time);
  if (place.allFinite()) return place.transpose();
  throw Error(ErrorCode::NotFinite, "the path of " + support + " is not finite at " + std::to_string(time) + " s");
}

}  // namespace

HeldPoints::HeldPoints(const ElasticSurface& surface, const Supports& supports)
    : supports_(supports), vertex_count_(surface.topology().vertex_count()) {
  std::vector<bool> held(static_cast<std::size_t>(vertex_count_), false);
  for (const Supports::FixedPoint& point : supports.points) {
    const std::string which = "vertex " + std::to_string(point.vertex);
    if (point.vertex < 0 || point.vertex >= vertex_count_) {
      throw Error(ErrorCode::IndexOutOfRange,
                  which + " is fixed, but the mesh has " + std::to_string(vertex_count_) + " vertices");
    }
    if (held[static_cast<std::size_t>(point.vertex)]) throw Error(ErrorCode::BadArgument, which + " is fixed twice");
    if (!point.path) throw Error(ErrorCode::BadArgument, which + " is fixed without a path");
    held[static_cast<std::size_t>(point.vertex)] = true;
  }
  for (std::size_t i = 0; i < supports.pins.size(); ++i) {
    if (!supports.pins[i].path) {
      throw Error(ErrorCode::BadArgument, "pin " + std::to_string(i) + " has no path");
    }
  }
  // A vertex at no face of the surface has empty rows in all matrices, and no force.
  const ElasticSurface::Matrix& pattern = surface.stiffness();
  for (Index v = 0; v < vertex_count_; ++v) {
    const bool outside = pattern.outerIndexPtr()[v] == pattern.outerIndexPtr()[v + 1];
    if (!held[static_cast<std::size_t>(v)] && !outside) free_.push_back(v);
  }
  pins_ = pin_rows(surface, supports.pins);
}

HeldPlaces HeldPoints::at(double time) const {
  HeldPlaces places{Points(vertex_count_, 3), Points(pin_count(), 3)};
  for (const Supports::FixedPoint& point : supports_.points) {
    places.points.row(point.vertex) = finite_place(point.path, time, "vertex " + std::to_string(point.vertex));
  }
  for (Index i = 0; i < pin_count(); ++i) {
    const auto& pin = supports_.pins[static_cast<std::size_t>(i)];
    places.pins.row(i) = finite_place(pin.path, time, "pin " + std::to_string(i));
  }
  return places;
}

void HeldPoints::lead(const HeldPlaces& places, Points& positions) const {
  for (const Supports::FixedPoint& point : supports_.points) {
    positions.row(point.vertex) = places.points.row(point.vertex);
  }
}

Points HeldPoints::reaction(const Points& force) const {
  std::vector<bool> is_free(static_cast<std::size_t>(vertex_count_), false);
  for (const Index v : free_) is_free[static_cast<std::size_t>(v)] = true;
  PlaceRows::Matrix spans = pins_.transposed;
  spans.prune([&](Eigen::Index v, Eigen::Index, double) { return bool{is_free[static_cast<std::size_t>(v)]}; });
  Eigen::LeastSquaresConjugateGradient<Eigen::SparseMatrix<double>> solver(spans);
  solver.setTolerance(1e-15);
  return spans * solver.solve(Eigen::MatrixXd(force));
}

double HeldPoints::error(const HeldPlaces& places, const Points& positions) const {
  double error = 0.0;
  for (const Supports::FixedPoint& point : supports_.points) {
    error = std::max(error, (positions.row(point.vertex) - places.points.row(point.vertex)).norm());
  }
  if (pin_count() > 0) error = std::max(error, (pins_.rows * positions - places.pins).rowwise().norm().maxCoeff());
  return error;
}

}  // namespace batten
