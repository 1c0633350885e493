/// \file Points that were placed by hand in 3D Slicer.
///
///   .mrk.json   markups: the control points of point lists and of open and closed curves, all lists of the file
///               together. Points that were not placed (positionStatus) are left out; lines, angles, planes and boxes
///               are refused, because their points lie on no border.
///   .fcsv       the older table of points: id or label, x, y, z, and more columns, which are skipped.
///
/// Both say the world that their numbers are in, LPS or RAS; a file that does not is refused, because left and right
/// would be a guess.
#pragma once
#include <string>
#include <string_view>

#include "batten/progress.h"
#include "batten/volume/volume.h"

namespace batten {

/// Whether a path ends with .mrk.json or .fcsv, in whatever case.
bool is_marked_points_path(const std::string& path);

/// N-by-3, in RAS whatever the file says, mm, in the order of the file. Throws Error, which names the file and the line
/// or the place in the document: FileNotReadable, BadFile (also for a file without points), NotFinite, Cancelled.
/// O(bytes).
Points read_marked_points(const std::string& path, const Progress& progress = {});

/// The same from the text of a file: .mrk.json where it begins with a brace. name: for messages.
Points marked_points(const std::string& name, std::string_view text);

}  // namespace batten
