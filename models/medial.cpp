/// Medial models: a sheet and a radius function on it, whose spokes are those of Blum's medial axis.
#include <cmath>
#include <numbers>
#include <utility>

#include "batten/mesh/topology.h"
#include "shapes.h"

namespace batten::models {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Four digits, as for the meshes; spokes too.
constexpr double kMedialGrain = 1e4;

void round_rows(Points& rows) { rows = (rows * kMedialGrain).array().round() / kMedialGrain + 0.0; }
void round_row(Vector3d& row) { row = (row * kMedialGrain).array().round() / kMedialGrain + 0.0; }

/// A sheet over (s, t), and the radius on it.
struct SheetRadius {
  std::function<Vector3d(double, double)> point;
  std::function<double(double, double)> radius;
};

/// The spokes r (-grad r +- sqrt(1 - |grad r|^2) n), where grad r is the gradient along the sheet and n its normal.
struct SpokesAt {
  Vector3d point;
  Vector3d up;
  Vector3d down;
  Vector3d crest;  ///< along the bisector of the two, where the sheet folds over
};

SpokesAt spokes_at(const SheetRadius& sheet, double s, double t, double elongation) {
  constexpr double kStep = 1e-5;
  const Vector3d along_s = (sheet.point(s + kStep, t) - sheet.point(s - kStep, t)) / (2.0 * kStep);
  const Vector3d along_t = (sheet.point(s, t + kStep) - sheet.point(s, t - kStep)) / (2.0 * kStep);
  const Vector2d slope((sheet.radius(s + kStep, t) - sheet.radius(s - kStep, t)) / (2.0 * kStep),
                       (sheet.radius(s, t + kStep) - sheet.radius(s, t - kStep)) / (2.0 * kStep));
  Eigen::Matrix2d metric;
  metric << along_s.dot(along_s), along_s.dot(along_t), along_s.dot(along_t), along_t.dot(along_t);
  const Vector2d weights = metric.inverse() * slope;
  const Vector3d gradient = weights.x() * along_s + weights.y() * along_t;
  const Vector3d normal = std::sqrt(1.0 - gradient.squaredNorm()) * along_s.cross(along_t).normalized();
  const double r = sheet.radius(s, t);
  return {sheet.point(s, t), r * (normal - gradient), r * (-normal - gradient),
          -elongation * r * gradient.normalized()};
}

/// Gives each atom its spokes. places: (s, t) of each atom; the figure has its faces.
void set_spokes(MedialFigure& figure, const SheetRadius& sheet, const Values& places, double elongation) {
  const Eigen::Index count = places.rows();
  figure.sheet.points = Points::Zero(count, 3);
  figure.up.resize(count, 3);
  figure.down.resize(count, 3);
  const Topology topology(figure.sheet);
  for (Index atom = 0; atom < static_cast<Index>(count); ++atom) {
    SpokesAt spokes = spokes_at(sheet, places(atom, 0), places(atom, 1), elongation);
    figure.sheet.points.row(atom) = spokes.point.transpose();
    figure.up.row(atom) = spokes.up.transpose();
    figure.down.row(atom) = spokes.down.transpose();
    if (!topology.is_boundary_vertex(atom)) continue;
    round_row(spokes.point);
    round_row(spokes.crest);
    figure.crest.push_back({atom, spokes.point, spokes.crest});
  }
  round_rows(figure.sheet.points);
  round_rows(figure.up);
  round_rows(figure.down);
}

/// rows by columns atoms over s in [-1, 1] along the columns and t in [-1, 1] along the rows.
MedialFigure rectangle(const std::string& name, const SheetRadius& sheet, Index rows, Index columns,
                       double elongation = 1.0) {
  MedialFigure figure;
  figure.name = name;
  set_rectangle(figure, rows, columns);
  Values places(static_cast<Eigen::Index>(rows) * columns, 2);
  for (Index i = 0; i < rows * columns; ++i) {
    const Index row = i / columns;
    places.row(i) << 2.0 * (i % columns) / (columns - 1) - 1.0, 2.0 * row / (rows - 1) - 1.0;
  }
  set_spokes(figure, sheet, places, elongation);
  return figure;
}

/// Over the disk s^2 + t^2 <= 1, with a spine along s.
MedialFigure disk(const SheetRadius& sheet, Index crest_points, Index steps) {
  constexpr double kSpine = 0.6;
  MedialFigure figure;
  const SpineGrid grid{crest_points, steps};
  set_ellipse(figure, grid);
  Values places(grid.atom_count(), 2);
  for (Index line = 0; line < crest_points; ++line) {
    const double turn = std::numbers::pi * (1.0 - 2.0 * line / crest_points);
    for (Index step = 0; step <= steps; ++step) {
      const double out = static_cast<double>(step) / steps;
      // The two lines that share a point of the spine turn by opposite angles.
      places.row(grid.atom(line, step)) << (kSpine + (1.0 - kSpine) * out) * std::cos(std::abs(turn)),
          out * std::sin(turn);
    }
  }
  set_spokes(figure, sheet, places, 1.0);
  return figure;
}

MedialModel one(MedialFigure figure) {
  MedialModel model;
  model.figures.push_back(std::move(figure));
  return model;
}

}  // namespace

MedialModel medial_slab() {
  return one(rectangle("slab",
                       {[](double s, double t) { return Vector3d(2.0 * s, 1.2 * t, 0.25 * s * s); },
                        [](double s, double t) { return 0.5 - 0.08 * std::pow(s, 6.0) - 0.08 * std::pow(t, 6.0); }},
                       5, 8));
}

MedialModel medial_tube() {
  // A strip along three quarters of a circle; the tube is thickest in its middle.
  const auto turn = [](double s) { return 0.75 * std::numbers::pi * s; };
  return one(rectangle(
      "tube",
      {[turn](double s, double t) { return Vector3d(2.0 * std::sin(turn(s)), -2.0 * std::cos(turn(s)), 0.3 * t); },
       [](double s, double t) { return 0.6 - 0.2 * s * s - 0.07 * t * t; }},
      3, 15));
}

MedialModel medial_bean() {
  return one(disk({[](double s, double t) {
                     return Vector3d((2.2 - 0.5 * t) * std::sin(0.9 * s), 1.1 * t - 2.2 * (std::cos(0.9 * s) - 1.0),
                                     0.0);
                   },
                   [](double s, double t) { return 0.8 - 0.35 * (s * s + t * t) + 0.06 * s; }},
                  20, 3));
}

namespace {

/// A prong of the fork: it leaves the handle's end at a place across it, and spreads.
MedialFigure prong(const std::string& name, double across) {
  return rectangle(name,
                   {[across](double s, double t) {
                      const double out = 1.0 + s;  // 0 at the hinge, 2 at the tip
                      return Vector3d(2.6 + 0.9 * out, across * (1.0 + 0.2 * out) + 0.28 * t, 0.06 * out * out);
                    },
                    [](double s, double t) { return 0.3 - 0.05 * s * s - 0.06 * t * t - 0.03 * s; }},
                   3, 6);
}

/// A thumb on the handle's upper side.
MedialFigure thumb() {
  return rectangle("thumb",
                   {[](double s, double t) {
                      const double out = 1.0 + s;
                      return Vector3d(-0.26 - 0.25 * out * out, 0.2 * t, 0.8 + 0.55 * out);
                    },
                    [](double s, double t) { return 0.32 - 0.06 * s * s - 0.04 * t * t; }},
                   3, 5);
}

}  // namespace

MedialModel medial_fork() {
  constexpr Index kRows = 7;
  constexpr Index kColumns = 8;
  MedialModel model =
      one(rectangle("handle",
                    {[](double s, double t) { return Vector3d(1.8 * s, 1.2 * t, 0.0); },
                     [](double s, double t) { return 0.45 - 0.06 * std::pow(s, 4.0) - 0.1 * std::pow(t, 4.0); }},
                    kRows, kColumns));
  model.figures.push_back(prong("left prong", 0.9));
  model.figures.push_back(prong("right prong", -0.9));
  model.figures.push_back(thumb());
  const auto end_atom = [](Index row) { return row * kColumns + kColumns - 1; };
  const std::vector<Index> start{0, 6, 12};  // of a prong
  const HingePlace left{0, {end_atom(4), end_atom(5), end_atom(6)}, {}, SpokeSide::Up};
  const HingePlace right{0, {end_atom(0), end_atom(1), end_atom(2)}, {}, SpokeSide::Up};
  model.hinges.push_back({{1, start, {}, SpokeSide::Up}, left});
  model.hinges.push_back({{2, start, {}, SpokeSide::Up}, right});
  // Four faces around the atom in the handle's middle row, left of its middle.
  const auto face = [](Index row, Index column) { return row * (kColumns - 1) + column; };
  const HingePlace top{0, {}, {face(2, 2), face(2, 3), face(3, 2), face(3, 3)}, SpokeSide::Up};
  model.hinges.push_back({{3, {0, 5, 10}, {}, SpokeSide::Up}, top});
  return model;
}

std::vector<MedialSample> medial_models() {
  return {{"slab.json", medial_slab()},
          {"bent-tube.json", medial_tube()},
          {"bean.srep.json", medial_bean()},
          {"fork.json", medial_fork()}};
}

}  // namespace batten::models
