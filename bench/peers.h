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

/// Create, refine uniformly, interpolate in floats.
PeerWork opensubdiv_refine(const Mesh& mesh, const Scheme& scheme, int levels);

/// Points again with connectivity kept: its PrimvarRefiner, and cascaded stencils on four floats a point.
std::vector<PeerWork> opensubdiv_points(const Mesh& mesh, const Scheme& scheme, int levels);

/// Empty where the library was not there at build time. Catmull-Clark without tags, Loop, or Modified
/// Butterfly.
std::vector<PeerWork> openmesh_refine(const Mesh& mesh, const Scheme& scheme, int levels);
std::vector<PeerWork> cgal_refine(const Mesh& mesh, const Scheme& scheme, int levels);
/// The same, Loop and Modified Butterfly (its filter repeats points where that has a boundary) only.
std::vector<PeerWork> vtk_refine(const Mesh& mesh, const Scheme& scheme, int levels);

class MarkdownTable;
/// Rows of jets at random places beside OpenSubdiv's Bfr, in doubles, one thread, processor time: ns a jet. The mesh's
/// faces are quads, or triangles for Loop.
void add_jets(MarkdownTable& table, const std::string& name, const Mesh& mesh, SchemeKind kind);

}  // namespace batten::bench
