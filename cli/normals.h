/// \file Wanted normals, as the options --normals and --normal-tolerance of several verbs ask for.
#pragma once
#include "batten/interpolate/local_normals.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {

/// The normals that --normals asks for at the vertices of the job's mesh; no row where it is not given. Reads their
/// file, if one is named.
Values wanted_for(const NormalArguments& arguments, const Topology& topology, Job& job);

/// The options for --normal-tolerance.
TurnOptions turn_options(double degrees);
/// Turns the surface's normals to those wanted; counts as a stage.
TurnReport turn_to(const Values& wanted, const NormalArguments& arguments, InterpolatedMesh& surface, Job& job);

/// What was turned and what was left, and how much the surface bends.
void add_normal_rows(const TurnReport& report, Table& table);
/// How far normals were and are from those wanted.
void add_angle_rows(const TurnReport& report, Table& table);
nlohmann::ordered_json normals_json(const TurnReport& report);

/// Draws the surface before its normals were turned and after, side by side, in the colours asked for.
void draw_turned(const InterpolatedMesh& before, const InterpolatedMesh& after, const TurnReport& report,
                 const PictureArguments& arguments, Job& job);
/// Lets the colours show how far normals were from those wanted, or are.
void show_angles(const Scalars& angles, const Topology& given, Subject& subject);

}  // namespace batten::cli
