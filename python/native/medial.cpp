#include "batten/medial/medial_surface.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "batten/expand/texture.h"
#include "batten/medial/medial_io.h"
#include "batten/progress.h"
#include "native/arrays.h"
#include "native/bind.h"
#include "native/calls.h"
#include "native/words.h"

namespace batten::python {

namespace {

const Words<TexturePreset> kTextures{{"marble", TexturePreset::Marble},
                                     {"wood", TexturePreset::Wood},
                                     {"granite", TexturePreset::Granite},
                                     {"rust", TexturePreset::Rust},
                                     {"clouds", TexturePreset::Clouds}};

/// The control mesh, the ends of the spokes, which its surface passes through, their lengths, and per spoke the
/// distance, the angle and the shift of the medial point.
py::tuple medial(const std::string& path, bool normals, const py::object& progress) {
  MedialSurface made = run(progress, [&](const Progress& report) {
    const MedialModel model = read_medial(path, progress_within(report, 0.0, 0.1));
    MedialSurface result = medial_surface(model, medial_interpolation(), progress_within(report, 0.1, 0.7));
    if (normals) turn_to_spokes(result, {}, progress_within(report, 0.7, 1.0));
    return result;
  });
  return py::make_tuple(std::move(made.surface.mesh), array_of(std::move(made.boundary.mesh.points)),
                        array_of(std::move(made.boundary.radii)), array_of(std::move(made.errors.distances)),
                        array_of(std::move(made.errors.angles)), array_of(std::move(made.errors.shifts)));
}

Mesh textured(const Topology& topology, const Scheme& scheme, const Mesh& control, const std::string& preset,
              std::uint64_t seed, double frequency, int levels, bool flat, double displacement,
              const py::object& progress) {
  const Texture texture = preset_texture(choice_of(preset, kTextures, "the preset"), {seed, frequency});
  return run(progress, [&](const Progress& report) {
    return textured_surface(topology, scheme, control, texture, {levels, flat, displacement}, report);
  });
}

}  // namespace

void bind_medial(py::module_& module) {
  module.def("medial", &medial);
  module.def("texture", &textured);
}

}  // namespace batten::python
