#include "batten/medial/medial_model.h"

#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/mesh/topology.h"

namespace batten {

namespace {

void require_atom_number(std::int64_t count) {
  if (count > std::numeric_limits<Index>::max() / 8)
    throw Error(ErrorCode::TooLarge, "a sheet of " + std::to_string(count) + " atoms is too large");
}

/// Adds the faces between two lines of an elliptical grid at a step.
void add_ellipse_faces(Mesh& sheet, const SpineGrid& grid, Index line, Index step) {
  const Index next = (line + 1) % grid.crest_points;
  const Index a = grid.atom(line, step);
  const Index b = grid.atom(next, step);
  const Index c = grid.atom(next, step + 1);
  const Index d = grid.atom(line, step + 1);
  const Index far_end = grid.crest_points / 2;
  const bool starts_at_end = line == 0 || line == far_end;
  const bool ends_at_end = next == 0 || next == far_end;
  if (step == 0 && starts_at_end) {
    sheet.add_face({a, b, c});
    sheet.add_face({a, c, d});
  } else if (step == 0 && ends_at_end) {
    sheet.add_face({a, b, d});
    sheet.add_face({b, c, d});
  } else {
    sheet.add_face({a, b, c, d});
  }
}

Eigen::RowVector2d ellipse_coordinates(const SpineGrid& grid, Index line, Index step) {
  const Index far_end = grid.crest_points / 2;
  if (line == 0) return {-step, 0.0};
  if (line == far_end) return {far_end + step, 0.0};
  return line < far_end ? Eigen::RowVector2d(line, step) : Eigen::RowVector2d(grid.crest_points - line, -step);
}

void require_rows(const MedialFigure& figure, const Points& spokes, const char* what) {
  if (spokes.rows() == figure.sheet.points.rows()) return;
  throw Error(ErrorCode::BadShape, "a figure of " + std::to_string(figure.atom_count()) + " atoms has " +
                                       std::to_string(spokes.rows()) + " spokes " + what + "; give one for each atom");
}

void require_spoke(const MedialFigure& figure, Index atom, const Eigen::Vector3d& spoke, const char* what) {
  const double length = spoke.norm();
  if (!std::isfinite(length))
    throw Error(ErrorCode::NotFinite, atom_name(figure, atom) + ": the " + what + " spoke is not finite");
  if (!(length > 0.0))
    throw Error(ErrorCode::BadArgument, atom_name(figure, atom) + ": the length of the " + what + " spoke is 0");
}

void require_crest(const MedialFigure& figure, const Topology& sheet) {
  Buffer<std::uint8_t> seen(static_cast<std::size_t>(figure.atom_count()), 0);
  for (const CrestSpoke& crest : figure.crest) {
    if (crest.atom < 0 || crest.atom >= figure.atom_count()) {
      throw Error(ErrorCode::IndexOutOfRange, "a crest spoke names atom " + std::to_string(crest.atom) + " of " +
                                                  std::to_string(figure.atom_count()));
    }
    if (!sheet.is_boundary_vertex(crest.atom)) {
      throw Error(
          ErrorCode::BadArgument,
          atom_name(figure, crest.atom) + ": has a crest spoke, but is not on the boundary of the sheet; leave it out");
    }
    if (seen[crest.atom] != 0)
      throw Error(ErrorCode::BadArgument, atom_name(figure, crest.atom) + ": has two crest spokes; leave one out");
    seen[crest.atom] = 1;
    require_spoke(figure, crest.atom, crest.spoke, "crest");
    if (!crest.origin.allFinite()) {
      throw Error(ErrorCode::NotFinite,
                  atom_name(figure, crest.atom) + ": the point where the crest spoke starts is not finite");
    }
  }
  for (Index atom = 0; atom < figure.atom_count(); ++atom) {
    if (!sheet.is_boundary_vertex(atom) || seen[atom] != 0) continue;
    throw Error(ErrorCode::BadArgument,
                atom_name(figure, atom) + ": is on the boundary of the sheet and needs a crest spoke");
  }
}

}  // namespace

void set_rectangle(MedialFigure& figure, Index rows, Index columns) {
  if (rows < 2 || columns < 2)
    throw Error(ErrorCode::BadArgument, "a rectangle of atoms needs 2 rows and 2 columns or more");
  require_atom_number(static_cast<std::int64_t>(rows) * columns);
  figure.grid.reset();
  figure.sheet.face_offsets = {0};
  figure.sheet.face_vertices.clear();
  figure.coordinates.resize(static_cast<Eigen::Index>(rows) * columns, 2);
  for (Index row = 0; row < rows; ++row) {
    for (Index column = 0; column < columns; ++column) {
      const Index atom = row * columns + column;
      figure.coordinates.row(atom) = Eigen::RowVector2d(column, row);
      if (row + 1 < rows && column + 1 < columns)
        figure.sheet.add_face({atom, atom + 1, atom + columns + 1, atom + columns});
    }
  }
}

void set_ellipse(MedialFigure& figure, const SpineGrid& grid) {
  if (grid.crest_points < 4 || grid.crest_points % 2 != 0 || grid.steps < 1) {
    throw Error(ErrorCode::BadArgument,
                "an elliptical grid has an even number of crest points, 4 or more, and a step "
                "or more; this one has " +
                    std::to_string(grid.crest_points) + " and " + std::to_string(grid.steps));
  }
  require_atom_number(static_cast<std::int64_t>(grid.crest_points) * (static_cast<std::int64_t>(grid.steps) + 1));
  figure.grid = grid;
  figure.sheet.face_offsets = {0};
  figure.sheet.face_vertices.clear();
  figure.coordinates.resize(grid.atom_count(), 2);
  for (Index line = 0; line < grid.crest_points; ++line) {
    for (Index step = 0; step < grid.steps; ++step) add_ellipse_faces(figure.sheet, grid, line, step);
    // A point of the spine that two lines share has v = 0 on both.
    for (Index step = 0; step <= grid.steps; ++step)
      figure.coordinates.row(grid.atom(line, step)) = ellipse_coordinates(grid, line, step);
  }
}

std::string atom_name(const MedialFigure& figure, Index atom) {
  std::string name = figure.name.empty() ? "" : figure.name + ", ";
  if (!figure.grid) return name + "atom " + std::to_string(atom);
  const Index beyond = atom - figure.grid->spine_count();
  const Index line = beyond < 0 ? atom : beyond / figure.grid->steps;
  const Index step = beyond < 0 ? 0 : beyond % figure.grid->steps + 1;
  return name + "line " + std::to_string(line) + ", step " + std::to_string(step);
}

void require_medial(const MedialModel& model) {
  if (model.figures.empty()) throw Error(ErrorCode::BadArgument, "the medial model has no figure");
  for (const MedialFigure& figure : model.figures) {
    require_rows(figure, figure.up, "up");
    require_rows(figure, figure.down, "down");
    if (figure.coordinates.rows() > 0 && figure.coordinates.rows() != figure.sheet.points.rows()) {
      throw Error(ErrorCode::BadShape, "a figure of " + std::to_string(figure.atom_count()) + " atoms has " +
                                           std::to_string(figure.coordinates.rows()) + " coordinates");
    }
    const Topology sheet(figure.sheet);
    for (Index atom = 0; atom < figure.atom_count(); ++atom) {
      if (sheet.is_isolated(atom)) {
        throw Error(ErrorCode::BadArgument,
                    atom_name(figure, atom) + ": is in no face of the sheet; leave it out or add one");
      }
      require_spoke(figure, atom, figure.up.row(atom).transpose(), "up");
      require_spoke(figure, atom, figure.down.row(atom).transpose(), "down");
    }
    require_crest(figure, sheet);
  }
}

}  // namespace batten
