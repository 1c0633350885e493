/// \file A fit by springs: an elastic surface is drawn to the points until forces balance, refined, and drawn on.
#pragma once
#include <cstdint>

#include "batten/buffer.h"
#include "batten/fit/fit_surface.h"

namespace batten {

/// Where a dynamic fit has come to.
struct DynamicFit {
  Topology topology;
  Scheme scheme;
  Points control;
};

/// After Qin, Mandal and Vemuri 1998 (key QMV98), sections 3.4 and 4: a spring from each point to the nearest place of
/// the surface, found anew in each step, draws a body of membrane and thin plate through time without mass; at
/// equilibrium the control mesh is refined, as long as options.vertices allows, and the springs draw on. A round of the
/// report is ten steps. Its objective is the energy of springs and body as the mean squared distance of the points, in
/// their unit squared, counts it.
/// start: the control mesh. points: N-by-3. outliers: one flag a point; these have no spring. diameter: of the points.
/// Fills report.rounds and report.end. Cancelled after the first round, the surface of the last whole round is
/// returned. Throws Error: what ElasticSurface and ElasticMotion throw.
DynamicFit fit_dynamic(const Mesh& start, const Points& points, const Buffer<std::uint8_t>& outliers,
                       const FitOptions& options, double diameter, FitReport& report, const Progress& progress = {});

}  // namespace batten
