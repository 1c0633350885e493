/// \file The same refinement by other libraries: from index lists in memory to refined points and connectivity.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/scheme/scheme.h"

namespace batten::bench {

struct PeerWork {
  std::string name;
  std::function<void()> work;
};

/// Builds, refines uniformly and interpolates in floats.
PeerWork opensubdiv_refine(const Mesh& mesh, const Scheme& scheme, int levels);

/// Computes the points again with the connectivity kept: by the PrimvarRefiner, and by cascaded stencils on four floats
/// per point.
std::vector<PeerWork> opensubdiv_points(const Mesh& mesh, const Scheme& scheme, int levels);

/// For Catmull-Clark without tags, Loop and Modified Butterfly. Empty if the library was missing at build time.
std::vector<PeerWork> openmesh_refine(const Mesh& mesh, const Scheme& scheme, int levels);
std::vector<PeerWork> cgal_refine(const Mesh& mesh, const Scheme& scheme, int levels);
/// For Loop and Modified Butterfly; VTK's filter repeats points where Modified Butterfly has a boundary.
std::vector<PeerWork> vtk_refine(const Mesh& mesh, const Scheme& scheme, int levels);

class MarkdownTable;
/// Adds rows of jets at random places beside OpenSubdiv's Bfr: doubles, one thread, nanoseconds of processor time per
/// jet. The mesh's faces are quads, or triangles for Loop.
void add_jets(MarkdownTable& table, const std::string& name, const Mesh& mesh, SchemeKind kind);

}  // namespace batten::bench
