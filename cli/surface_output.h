/// \file What a verb writes whose result is a control mesh.
#pragma once
#include <string>

#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"
#include "cli/job.h"

namespace batten::cli {

/// A mesh and the surface that it controls.
struct ControlMesh {
  const Mesh& mesh;
  const Topology& topology;
  const Scheme& scheme;
};

/// Writes the control mesh, or where `levels` is not -1, or the format holds nothing else, its limit surface refined so
/// often. Returns what the table says was written when it is not the control mesh; empty otherwise.
std::string write_surface(const ControlMesh& control, int levels, Job& job);

}  // namespace batten::cli
