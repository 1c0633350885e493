#include "bench/peers.h"

#ifdef BATTEN_BENCH_VTK
#include <vtkButterflySubdivisionFilter.h>
#include <vtkCellArray.h>
#include <vtkLoopSubdivisionFilter.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#endif

namespace batten::bench {

#ifdef BATTEN_BENCH_VTK

namespace {

template <typename Filter>
void refine(const Mesh& mesh, int levels) {
  vtkNew<vtkPoints> points;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    points->InsertNextPoint(mesh.points(v, 0), mesh.points(v, 1), mesh.points(v, 2));
  }
  vtkNew<vtkCellArray> faces;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index* corners = &mesh.face_vertices[mesh.face_offsets[f]];
    const vtkIdType triangle[] = {corners[0], corners[1], corners[2]};
    faces->InsertNextCell(3, triangle);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(faces);
  vtkNew<Filter> filter;
  filter->SetInputData(data);
  filter->SetNumberOfSubdivisions(levels);
  filter->Update();
}

}  // namespace

std::vector<PeerWork> vtk_refine(const Mesh& mesh, const Scheme& scheme, int levels) {
  if (scheme.kind == SchemeKind::Loop) {
    return {{"VTK", [&mesh, levels] { refine<vtkLoopSubdivisionFilter>(mesh, levels); }}};
  }
  if (scheme.kind == SchemeKind::ModifiedButterfly) {
    return {{"VTK", [&mesh, levels] { refine<vtkButterflySubdivisionFilter>(mesh, levels); }}};
  }
  return {};
}

#else

std::vector<PeerWork> vtk_refine(const Mesh& /*mesh*/, const Scheme& /*scheme*/, int /*levels*/) { return {}; }

#endif

}  // namespace batten::bench
