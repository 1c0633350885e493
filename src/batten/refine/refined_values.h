/// \file The control values of one refinement step, without its connectivity.
#pragma once
#include <span>

#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// Vertices of the parent, then one an edge, then, for Catmull-Clark, one a face.
Index refined_vertex_count(const Topology& topology, SchemeKind kind);

/// values: V-by-k; out: room for refined_vertex_count() rows of k numbers, in that order; vertex_alpha: empty, or one
/// for each vertex instead of scheme.alpha. Sums are in double whatever Scalar is (float or double). Trusts its caller
/// about sizes and alpha. Throws Error(Cancelled).
template <typename Scalar>
void refine_values(const Topology& topology, const Scheme& scheme, std::span<const double> vertex_alpha,
                   ConstValuesRef values, Scalar* out, const Progress& progress = {});

}  // namespace batten
