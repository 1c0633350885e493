/// \file Reads and writes medial models: 3D Slicer's elliptical s-reps (.srep.json) and Batten's own JSON.
///
///   .srep.json  {"EllipticalSRep": {"CrestPoints": C, "Steps": S, "Skeleton": [line][step]}}, C lines of S + 1 points,
///               each with "UpSpoke", "DownSpoke" and at the last step "CrestSpoke"; a spoke has a "SkeletalPoint" and
///               a "Direction" (whose length is the spoke's), each with "CoordinateSystem" ("LPS" or "RAS") and "Value"
///               (three numbers). Everything becomes LPS, the frame of DICOM and of 3D Slicer's files: in RAS the first
///               two numbers have the other sign. The points of the spine stand twice and must agree.
///   .json       {"figures": [{"name": "...", "grid": [rows, columns] or "faces": [[0, 1, 6, 5], ...],
///               "atoms": [{"position": [x, y, z], "radius": r, "up": [...], "down": [...], "uv": [u, v],
///               "crest": [...] or "elongation": e}, ...]}]}. With "radius", a number or [up, down], the vectors "up"
///               and "down" are directions; without it they are the spokes. An atom at the edge of the sheet may have
///               "crest", its crest spoke ({"position": [...], "spoke": [...]} where it starts elsewhere), or
///               "elongation": the crest spoke goes along the bisector of the other two directions and is so many
///               radii long; 1 if neither is given. "hinges": [{"child": PLACE, "parent": PLACE}, ...] beside "figures"
///               joins figures; a PLACE is {"figure": number or name, "edge": [atoms along the edge of the sheet]} or
///               {"figure": ..., "side": "up" or "down", "faces": [faces of the sheet]}.
#pragma once
#include <string>
#include <vector>

#include "batten/medial/medial_model.h"

namespace batten {

/// Reads either format, whatever the file's name; also packed by gzip. "-" is standard input.
/// Throws Error(FileNotReadable), and Error(BadFile), which names the figure, the atom or the line and step, for what
/// is missing or is not what the format says; whatever require_medial throws, with the file's name. O(bytes).
MedialModel read_medial(const std::string& path, const Progress& progress = {});

/// Throws what write_medial would for this path, whatever the numbers are: Error(UnknownFormat) for another extension
/// than .json, Error(BadArgument) for a .srep.json of anything but one figure on an elliptical grid.
void require_medial_format(const std::string& path, const MedialModel& model);

/// Writes .srep.json where the path ends so, otherwise Batten's own JSON; numbers read back bit for bit. "-" is
/// standard output. Throws Error(FileNotWritable), and what require_medial_format and require_medial throw.
void write_medial(const std::string& path, const MedialModel& model);

/// What a file written by write_medial(path, model) lacks of the model, in words such as "the figure's name"; empty if
/// reading the file gives all of it.
std::vector<std::string> find_medial_losses(const std::string& path, const MedialModel& model);

/// True if the path ends with .srep.json, in capital letters or not.
bool is_srep_path(const std::string& path);

}  // namespace batten
