/// \file Everything of the library but pictures (render/render.h).
#pragma once
#include "batten/error.h"
#include "batten/expand/mesh_series.h"
#include "batten/interpolate/interpolator.h"
#include "batten/io/io.h"
#include "batten/limit/adaptive.h"
#include "batten/limit/curvature.h"
#include "batten/limit/limit_matrix.h"
#include "batten/limit/limit_surface.h"
#include "batten/limit/nearest_point.h"
#include "batten/limit/surface_mesh.h"
#include "batten/limit/surface_side.h"
#include "batten/limit/surface_weights.h"
#include "batten/limit/tessellator.h"
#include "batten/mesh/check.h"
#include "batten/mesh/mesh.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/repair.h"
#include "batten/mesh/summary.h"
#include "batten/mesh/topology.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/threads.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"
#include "batten/scheme/scheme.h"

/// Subdivision surfaces through data.
namespace batten {}
