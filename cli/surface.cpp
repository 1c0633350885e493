/// From control points to something that can be drawn or written: the refined limit mesh, the picture.
#include <algorithm>

#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/parallel/parallel.h"
#include "cli/common.h"
#ifdef BATTEN_WITH_RENDER
#include "batten/render/render.h"
#endif

namespace batten::cli {

Mesh limit_mesh(const Topology& topology, const Scheme& scheme, ConstValuesRef control, int levels, bool quiet) {
  ProgressBar bar("refining", quiet);
  const RefinedSurface refined = refine(with_surface_holes(topology, scheme), scheme, control, levels, bar.callback());
  const Scheme last = levels > 0 ? scheme.after_first_step() : scheme;
  Mesh mesh;
  mesh.points = LimitMatrix(refined.topology, last, {}, bar.callback()).apply(refined.values, bar.callback());
  mesh.face_vertices.reserve(refined.topology.tables().origins.size());
  for (Index f = 0; f < refined.topology.face_count(); ++f) {
    if (refined.topology.is_hole(f)) continue;
    for (Index h = refined.topology.face_begin(f); h < refined.topology.face_end(f); ++h) {
      mesh.face_vertices.push_back(refined.topology.origin(h));
    }
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  return mesh;
}

int picture_levels(const Topology& topology) {
  constexpr double kFaces = 4e5;
  double faces = std::max<Index>(topology.face_count(), 1);
  int levels = 0;
  while (levels < 5 && faces * 4.0 <= kFaces) {
    faces *= 4.0;
    ++levels;
  }
  return levels;
}

#ifdef BATTEN_WITH_RENDER

void draw(const Mesh& surface, const Points& markers, const Mesh& lines, const PictureRequest& request) {
  Scene scene;
  scene.surface = surface;
  scene.markers = markers;
  scene.lines = lines;
  RenderOptions options;
  options.width = request.width;
  options.height = request.height;
  options.samples = request.samples;
  options.view = request.view;
  ProgressBar bar("drawing", request.quiet);
  write_png(request.path, render(scene, options, bar.callback()));
}

#else

void draw(const Mesh& /*surface*/, const Points& /*markers*/, const Mesh& /*lines*/,
          const PictureRequest& /*request*/) {
  throw Error(ErrorCode::NotAvailable, "this build has no pictures; configure with BATTEN_WITH_RENDER=ON");
}

#endif

}  // namespace batten::cli
