/// \file Medial models with spokes in Blum's sense, from a radius function on a sheet.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "batten/medial/medial_model.h"
#include "batten/mesh/topology.h"

namespace batten::test {

/// A flat sheet in z = 0 with r = r0 - (c x^2 + d y^2) / 2: the spokes are r (-grad r +- sqrt(1 - |grad r|^2) e_z).
struct FlatRadius {
  double middle = 0.5;
  double along = 0.1;   ///< c
  double across = 0.3;  ///< d
};

/// Gives the atoms at `places` (A-by-2) their spokes; needs the faces of the sheet.
inline void set_flat_spokes(MedialFigure& figure, const Values& places, const FlatRadius& radius = {}) {
  const Eigen::Index count = places.rows();
  figure.sheet.points = Points::Zero(count, 3);
  figure.up.resize(count, 3);
  figure.down.resize(count, 3);
  figure.sheet.points.leftCols(2) = places;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double x = places(i, 0);
    const double y = places(i, 1);
    const double r = radius.middle - 0.5 * (radius.along * x * x + radius.across * y * y);
    const Eigen::Vector2d slope(-radius.along * x, -radius.across * y);
    const double height = std::sqrt(1.0 - slope.squaredNorm());
    figure.up.row(i) = r * Eigen::RowVector3d(-slope.x(), -slope.y(), height);
    figure.down.row(i) = r * Eigen::RowVector3d(-slope.x(), -slope.y(), -height);
  }
  const Topology sheet(figure.sheet);
  figure.crest.clear();
  for (Index atom = 0; atom < figure.atom_count(); ++atom) {
    if (!sheet.is_boundary_vertex(atom)) continue;
    const Eigen::Vector3d both = (figure.up.row(atom) + figure.down.row(atom)).transpose();
    figure.crest.push_back(
        {atom, figure.sheet.points.row(atom).transpose(), figure.up.row(atom).norm() * both.normalized()});
  }
}

/// rows by columns atoms over [-2, 2] x [-1, 1].
inline MedialModel slab(Index rows, Index columns) {
  MedialModel model;
  MedialFigure& figure = model.figures.emplace_back();
  set_rectangle(figure, rows, columns);
  Values places(static_cast<Eigen::Index>(rows) * columns, 2);
  for (Index i = 0; i < rows * columns; ++i)
    places.row(i) << 4.0 * (i % columns) / (columns - 1) - 2.0, 2.0 * (i / columns) / (rows - 1) - 1.0;
  set_flat_spokes(figure, places);
  return model;
}

/// An elliptical s-rep over an ellipse of half axes 2 and 1, with a spine from -1.4 to 1.4.
inline MedialModel ellipse(Index crest_points, Index steps) {
  MedialModel model;
  MedialFigure& figure = model.figures.emplace_back();
  const SpineGrid grid{crest_points, steps};
  set_ellipse(figure, grid);
  Values places(grid.atom_count(), 2);
  for (Index line = 0; line < crest_points; ++line) {
    const double turn = std::numbers::pi * (1.0 - 2.0 * line / crest_points);
    for (Index step = 0; step <= steps; ++step) {
      const double t = static_cast<double>(step) / steps;
      // Exactly the same point of the spine for both of its lines.
      const double cosine = std::cos(std::abs(turn));
      places.row(grid.atom(line, step)) << (1.4 + 0.6 * t) * cosine, t * std::sin(turn);
    }
  }
  set_flat_spokes(figure, places);
  return model;
}

/// The volume inside closed faces, positive where they are counter-clockwise seen from outside.
inline double volume_of(const Mesh& mesh) {
  double sum = 0.0;
  for (Index face = 0; face < mesh.face_count(); ++face) {
    const Index* corners = mesh.face_vertices.data() + mesh.face_offsets[face];
    for (Index k = 1; k + 1 < mesh.face_size(face); ++k) {
      const Eigen::RowVector3d a = mesh.points.row(corners[0]);
      const Eigen::RowVector3d b = mesh.points.row(corners[k]);
      const Eigen::RowVector3d c = mesh.points.row(corners[k + 1]);
      sum += a.dot(b.cross(c)) / 6.0;
    }
  }
  return sum;
}

}  // namespace batten::test
