#include "bench/peers.h"

#ifdef BATTEN_BENCH_OPENMESH
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/CatmullClarkT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/LoopT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/ModifiedButterFlyT.hh>
#endif

namespace batten::bench {

#ifdef BATTEN_BENCH_OPENMESH

namespace {

template <typename Target>
void fill(const Mesh& mesh, Target& target) {
  std::vector<typename Target::VertexHandle> handles;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    handles.push_back(target.add_vertex({static_cast<float>(mesh.points(v, 0)), static_cast<float>(mesh.points(v, 1)),
                                         static_cast<float>(mesh.points(v, 2))}));
  }
  std::vector<typename Target::VertexHandle> corners;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    corners.clear();
    for (Index c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) {
      corners.push_back(handles[mesh.face_vertices[c]]);
    }
    target.add_face(corners);
  }
}

template <typename Target, typename Subdivider>
void refine(const Mesh& mesh, int levels) {
  Target target;
  fill(mesh, target);
  Subdivider subdivider;
  subdivider.attach(target);
  subdivider(static_cast<std::size_t>(levels));
  subdivider.detach();
}

}  // namespace

std::vector<PeerWork> openmesh_refine(const Mesh& mesh, const Scheme& scheme, int levels) {
  using Quads = OpenMesh::PolyMesh_ArrayKernelT<>;
  using Triangles = OpenMesh::TriMesh_ArrayKernelT<>;
  if (scheme.kind == SchemeKind::Loop) {
    return {{"OpenMesh", [&mesh, levels] {
               refine<Triangles, OpenMesh::Subdivider::Uniform::LoopT<Triangles, float>>(mesh, levels);
             }}};
  }
  if (scheme.kind == SchemeKind::ModifiedButterfly) {
    return {{"OpenMesh", [&mesh, levels] {
               refine<Triangles, OpenMesh::Subdivider::Uniform::ModifiedButterflyT<Triangles, float>>(mesh, levels);
             }}};
  }
  return {{"OpenMesh", [&mesh, levels] {
             refine<Quads, OpenMesh::Subdivider::Uniform::CatmullClarkT<Quads, float>>(mesh, levels);
           }}};
}

#else

std::vector<PeerWork> openmesh_refine(const Mesh& /*mesh*/, const Scheme& /*scheme*/, int /*levels*/) { return {}; }

#endif

}  // namespace batten::bench
