#include "batten/render/render.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <optional>

#include "native/arrays.h"
#include "native/bind.h"
#include "native/calls.h"
#include "native/words.h"

namespace batten::python {

namespace {

const Words<View> kViews{{"auto", View::Auto},   {"front", View::Front}, {"back", View::Back},     {"left", View::Left},
                         {"right", View::Right}, {"top", View::Top},     {"bottom", View::Bottom}, {"iso", View::Iso}};
const Words<ColorMap> kMaps{{"sequential", ColorMap::Sequential}, {"diverging", ColorMap::Diverging}};
const Words<UpAxis> kAxes{{"auto", UpAxis::Auto}, {"x", UpAxis::X},       {"y", UpAxis::Y},      {"z", UpAxis::Z},
                          {"-x", UpAxis::MinusX}, {"-y", UpAxis::MinusY}, {"-z", UpAxis::MinusZ}};

/// h-by-w-by-3, or by 4 where the background is transparent. values, colors, normals, markers: without rows for none.
py::array_t<unsigned char> picture(const Mesh& surface, const std::optional<Mesh>& lines, const Doubles& values,
                                   const std::string& map, const std::optional<std::array<double, 2>>& range,
                                   const Doubles& colors, const Doubles& normals, const Doubles& markers, int width,
                                   int height, const std::string& view, const std::string& up, bool zebra,
                                   bool transparent, const py::object& progress) {
  Scene scene;
  scene.surface = surface;
  if (lines) scene.lines = *lines;
  if (values.size() > 0) {
    scene.scalars = rows_of(values).col(0);
    ScaleRequest request;
    request.map = choice_of(map, kMaps, "the map");
    request.range = range;
    scene.scale = fit_color_scale(scene.scalars, request);
  }
  if (colors.size() > 0) scene.colors = points_of(colors, "colours");
  if (normals.size() > 0) scene.normals = points_of(normals, "normals");
  if (markers.size() > 0) scene.markers = points_of(markers, "markers");
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.view = choice_of(view, kViews, "the view");
  options.up = choice_of(up, kAxes, "the up axis");
  options.shading = zebra ? Shading::Zebra : Shading::Plain;
  options.style.transparent = transparent;
  Picture drawn = run(progress, [&](const Progress& report) { return render(scene, options, report); });
  return array_over<unsigned char>(std::move(drawn.pixels), {drawn.height, drawn.width, drawn.channels});
}

void save(const std::string& path,
          const py::array_t<unsigned char, py::array::c_style | py::array::forcecast>& pixels) {
  if (pixels.ndim() != 3) throw Error(ErrorCode::BadShape, "a picture is an array of shape (h, w, 3) or (h, w, 4)");
  Picture drawn;
  drawn.height = static_cast<int>(pixels.shape(0));
  drawn.width = static_cast<int>(pixels.shape(1));
  drawn.channels = static_cast<int>(pixels.shape(2));
  drawn.pixels.assign(pixels.data(), pixels.data() + pixels.size());
  write_png(path, drawn);
}

}  // namespace

void bind_render(py::module_& module) {
  module.def("render", &picture);
  module.def("write_png", &save);
}

}  // namespace batten::python
