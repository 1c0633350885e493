/// \file One-rings of control points turned about their limit points. For local_normals.cpp.
#pragma once
#include "batten/interpolate/turn_report.h"
#include "batten/limit/vertex_frames.h"
#include "batten/progress.h"

namespace batten {

/// Turns the rings of the first wanted.rows() vertices, whose one-rings must be disjoint, by the smallest rotations
/// that bring their normals to within `tolerance`. control: of the mesh of `frames`. wanted: unit or zero rows. Fills
/// the report but for its energy and what is measured at the end.
void turn_rings(const VertexFrames& frames, ConstValuesRef wanted, double tolerance, Values& control,
                TurnReport& report, const Progress& progress);

/// Measures report.after where report.before has an angle.
void measure_turned(const VertexFrames& frames, ConstValuesRef wanted, const Values& control, TurnReport& report);

}  // namespace batten
