#include "bench/peers.h"

#ifdef BATTEN_BENCH_CGAL
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>
#endif

namespace batten::bench {

#ifdef BATTEN_BENCH_CGAL

std::vector<PeerWork> cgal_refine(const Mesh& mesh, const Scheme& scheme, int levels) {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Target = CGAL::Surface_mesh<Kernel::Point_3>;
  return {{"CGAL", [&mesh, scheme, levels] {
             Target target;
             std::vector<Target::Vertex_index> handles;
             for (Index v = 0; v < mesh.vertex_count(); ++v) {
               handles.push_back(target.add_vertex({mesh.points(v, 0), mesh.points(v, 1), mesh.points(v, 2)}));
             }
             std::vector<Target::Vertex_index> corners;
             for (Index f = 0; f < mesh.face_count(); ++f) {
               corners.clear();
               for (Index c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) {
                 corners.push_back(handles[mesh.face_vertices[c]]);
               }
               target.add_face(corners);
             }
             const auto parameters = CGAL::parameters::number_of_iterations(levels);
             if (scheme.kind == SchemeKind::Loop) {
               CGAL::Subdivision_method_3::Loop_subdivision(target, parameters);
             } else {
               CGAL::Subdivision_method_3::CatmullClark_subdivision(target, parameters);
             }
           }}};
}

#else

std::vector<PeerWork> cgal_refine(const Mesh& /*mesh*/, const Scheme& /*scheme*/, int /*levels*/) { return {}; }

#endif

}  // namespace batten::bench
