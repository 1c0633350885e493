/// \file Medial models: sheets of atoms inside a solid, whose spokes end on its boundary (m-reps and s-reps).
///
/// An atom is a point p of a medial sheet with two spokes, vectors from p to the boundary above and below the sheet. At
/// the edge of the sheet, where it folds over, the atom has a third one, the crest spoke, which may start from a point
/// of its own. In Blum's sense an atom's spokes have one length, the radius r, and are normal to the boundary where
/// they end; skeletal representations allow others (medial/medial_check.h measures how far).
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten {

/// The side of the sheet that a spoke belongs to; as a number it is what the attribute "medial" holds.
enum class SpokeSide { Down = -1, Crest = 0, Up = 1 };

/// The spoke at the fold of the sheet.
struct CrestSpoke {
  Index atom = -1;         ///< an atom on the boundary of the sheet
  Eigen::Vector3d origin;  ///< where the spoke starts: the atom itself, or a point beside it
  Eigen::Vector3d spoke;   ///< from there to the boundary of the solid
};

/// How the atoms of 3D Slicer's elliptical s-reps are ordered: on lines around a spine, step by step from the spine to
/// the crest. Line 0 starts at one end of the spine and line crest_points / 2 at the other; line i and line
/// crest_points - i start at the same point of the spine.
struct SpineGrid {
  Index crest_points = 0;  ///< lines; even, 4 or more
  Index steps = 0;         ///< 1 or more; each line has steps + 1 points

  Index spine_count() const { return crest_points / 2 + 1; }
  Index atom_count() const { return spine_count() + crest_points * steps; }
  /// The atom at a step of a line: first come the points of the spine, then the others line by line.
  Index atom(Index line, Index step) const {
    if (step > 0) return spine_count() + line * steps + step - 1;
    return line < spine_count() ? line : crest_points - line;
  }
};

/// One sheet of atoms. Plain data: nothing in it is trusted (require_medial).
struct MedialFigure {
  std::string name;
  Mesh sheet;                     ///< row i of the points is atom i; its faces, mostly quads, say which are neighbours
  Points up = Points(0, 3);       ///< row i: the spoke of atom i on one side
  Points down = Points(0, 3);     ///< and on the other
  std::vector<CrestSpoke> crest;  ///< one for each atom on the boundary of the sheet, in any order
  Values coordinates = Values(0, 2);  ///< (u, v) of each atom on the sheet, or no row
  std::optional<SpineGrid> grid;      ///< where the figure is an elliptical s-rep

  Index atom_count() const { return sheet.vertex_count(); }
};

/// Where a figure's boundary opens for another figure: along a part of its crest, or over some faces of its sheet.
struct HingePlace {
  Index figure = -1;
  std::vector<Index> edge;   ///< atoms one after the other along the boundary of the sheet, two or more; or none
  std::vector<Index> faces;  ///< without an edge: faces of the sheet that form a disk, on the side `side`
  SpokeSide side = SpokeSide::Up;
};

/// A figure that grows out of another one: their boundaries are opened and joined by a ring of faces. The ends of
/// spokes all of whose faces are opened are not on the surface then.
struct MedialHinge {
  HingePlace child;
  HingePlace parent;
};

/// Figures, each with a closed surface of its own but where hinges join them.
struct MedialModel {
  std::vector<MedialFigure> figures;
  std::vector<MedialHinge> hinges;
};

/// The faces of a sheet of rows * columns atoms, row by row, and (u, v) = (column, row) as coordinates.
/// Throws Error(BadArgument) unless both are 2 or more, Error(TooLarge).
void set_rectangle(MedialFigure& figure, Index rows, Index columns);

/// The faces of an elliptical grid. u counts the points along the spine, v the steps from it, negative on the lines
/// behind crest_points / 2; the two end lines go on along u. Around each end of the spine there are four triangles, so
/// that each atom has a normal; all other faces are quads.
/// Throws Error(BadArgument) for an odd number of lines, fewer than 4, or no step, Error(TooLarge).
void set_ellipse(MedialFigure& figure, const SpineGrid& grid);

/// What messages call an atom: "line 3, step 1" on an elliptical grid, otherwise "atom 17"; with the figure's name if
/// it has one.
std::string atom_name(const MedialFigure& figure, Index atom);

/// Throws Error unless each figure has a spoke of finite positive length up and down for each atom and a crest spoke
/// for each atom on the boundary of its sheet and for no other: BadShape, NotFinite, BadArgument, IndexOutOfRange; and
/// what Topology throws for the sheet. Hinges are checked where they act (medial_boundary). O(atoms).
void require_medial(const MedialModel& model);

}  // namespace batten
