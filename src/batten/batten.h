/// \file Everything of the library's core.
#pragma once
#include "batten/error.h"
#include "batten/interpolate/interpolator.h"
#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/check.h"
#include "batten/mesh/mesh.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/topology.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refinement.h"
#include "batten/scheme/scheme.h"
