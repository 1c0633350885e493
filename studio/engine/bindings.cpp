/// What JavaScript sees: names as in the library, in JavaScript's case. Every function returns a result, or a failure.
#include <emscripten/bind.h>

#include "studio/engine/elastic.h"
#include "studio/engine/mesh_file.h"
#include "studio/engine/operations.h"
#include "studio/engine/surface.h"

namespace batten::studio {

EMSCRIPTEN_BINDINGS(batten) {
  using emscripten::class_;
  using emscripten::function;
  class_<MeshFile>("MeshFile")
      .smart_ptr<std::shared_ptr<MeshFile>>("MeshFilePointer")
      .function("contents", &MeshFile::contents)
      .function("problems", &MeshFile::problems)
      .function("setPoints", &MeshFile::set_points)
      .function("setTags", &MeshFile::set_tags)
      .function("repaired", &MeshFile::repaired)
      .function("write", &MeshFile::write)
      .function("writeAdaptive", &MeshFile::write_adaptive)
      .function("writeNormals", &MeshFile::write_normals);
  class_<Surface>("Surface")
      .smart_ptr<std::shared_ptr<Surface>>("SurfacePointer")
      .function("report", &Surface::report)
      .function("drawing", &Surface::drawing)
      .function("shape", &Surface::shape)
      .function("change", &Surface::change)
      .function("move", &Surface::move)
      .function("follow", &Surface::follow)
      .function("limitPoints", &Surface::limit_points)
      .function("field", &Surface::field)
      .function("texture", &Surface::texture)
      .function("probe", &Surface::probe)
      .function("distances", &Surface::distances)
      .function("controlFile", &Surface::control_file);
  class_<Elastic>("Elastic")
      .smart_ptr<std::shared_ptr<Elastic>>("ElasticPointer")
      .function("grab", &Elastic::grab)
      .function("pull", &Elastic::pull)
      .function("release", &Elastic::release)
      .function("step", &Elastic::step)
      .function("pin", &Elastic::pin)
      .function("refine", &Elastic::refine)
      .function("control", &Elastic::control)
      .function("controlFile", &Elastic::control_file);
  class_<ShapeMorph>("ShapeMorph")
      .smart_ptr<std::shared_ptr<ShapeMorph>>("ShapeMorphPointer")
      .function("at", &ShapeMorph::at)
      .function("film", &ShapeMorph::film);
  function("readMesh", &read_mesh_file);
  function("makeSurface", &make_surface);
  function("makeElastic", &make_elastic);
  function("denoisedPoints", &denoised_points);
  function("bandedPoints", &banded_points);
  function("makeMorph", &make_morph);
  function("comparedMethods", &compared_methods);
  function("fitted", &fitted);
}

}  // namespace batten::studio
