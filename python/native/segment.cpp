#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <vector>

#include "batten/volume/inside_volume.h"
#include "batten/volume/marked_points.h"
#include "batten/volume/segment_together.h"
#include "native/arrays.h"
#include "native/bind.h"
#include "native/calls.h"
#include "native/summary.h"
#include "native/voxels.h"
#include "native/words.h"

namespace batten::python {

namespace {

const Words<WorldSpace> kSpaces{{"ras", WorldSpace::Ras}, {"lps", WorldSpace::Lps}};

/// What the keys of a dictionary say; None where nothing is said.
template <typename Value>
std::optional<Value> said(const py::dict& options, const char* key) {
  return options[key].cast<std::optional<Value>>();
}

SegmentRequest request_of(const py::dict& options, WorldSpace space) {
  SegmentRequest request;
  request.surface.vertices = said<Index>(options, "vertices").value_or(request.surface.vertices);
  request.surface.genus = said<Index>(options, "genus");
  request.surface.smoothing = said<double>(options, "smoothing").value_or(request.surface.smoothing);
  if (const auto scheme = said<std::string>(options, "scheme"))
    request.surface.scheme.kind = choice_of(*scheme, kSchemes, "the scheme");
  request.label = options["label"].cast<std::vector<double>>();
  request.points = in_space(points_of(options["points"].cast<Doubles>()), space);
  if (const auto seed = said<std::array<double, 3>>(options, "seed")) {
    Points place(1, 3);
    place << (*seed)[0], (*seed)[1], (*seed)[2];
    request.seed = in_space(place, space).row(0).transpose();
  }
  if (const auto numbers = said<std::array<double, 2>>(options, "numbers"))
    request.seed_options.range = NumberRange{(*numbers)[0], (*numbers)[1]};
  if (!options["start"].is_none()) request.start = in_space(options["start"].cast<const Mesh&>(), space);
  request.edges = options["edges"].cast<bool>();
  return request;
}

py::dict report_of(const SegmentResult& found) {
  const Segmentation& surface = found.surface;
  py::dict report;
  report["vertices"] = surface.topology.vertex_count();
  report["faces"] = surface.topology.face_count();
  report["scheme"] = word_of(surface.scheme.kind, kSchemes);
  report["genus"] = surface.genus;
  report["components"] = surface.components;
  report["dropped_parts"] = surface.dropped_parts;
  report["rounds"] = surface.rounds;
  report["cut_steps"] = surface.cut_steps;
  report["volume"] = found.measures.volume;
  report["area"] = found.measures.area;
  report["self_intersections"] = found.measures.self_intersections;
  report["edge_strength"] = found.edges.mean;
  report["best_edge_strength"] = found.edges.best;
  for (const char* key : {"mask_volume", "dice", "to_surface", "to_border", "region_volume", "region_open"})
    report[key] = py::none();
  if (found.agreement) {
    report["mask_volume"] = found.agreement->mask_volume;
    report["dice"] = found.agreement->dice;
    report["to_surface"] = dict_of(found.agreement->to_surface);
    report["to_border"] = dict_of(found.agreement->to_border);
  }
  if (found.region) {
    report["region_volume"] = found.region->volume;
    report["region_open"] = found.region->open;
  }
  return report;
}

using MaskPair = std::optional<std::pair<Voxels, Doubles>>;  ///< values and affine

/// The control mesh and the fine mesh, in `space`, and the report.
py::tuple tuple_of(SegmentResult&& found, WorldSpace space) {
  py::dict report = report_of(found);
  return py::make_tuple(in_space(std::move(found.surface.mesh), space), in_space(std::move(found.measures.fine), space),
                        report);
}

py::tuple segment(const Voxels& values, const Doubles& affine, const MaskPair& mask, const py::dict& options,
                  const std::string& world, const py::object& progress) {
  const WorldSpace space = choice_of(world, kSpaces, "the space");
  const Volume image = volume_of(values, affine);
  SegmentRequest request = request_of(options, space);
  if (mask) request.labels = volume_of(mask->first, mask->second);
  if (const auto slices = said<Index>(options, "slices")) take_contours(request, *slices);
  SegmentResult found = run(progress, [&](const Progress& report) { return segment_volume(image, request, report); });
  return tuple_of(std::move(found), space);
}

/// A list of what segment() gives, and how the surfaces were kept apart.
py::tuple together(const Voxels& values, const Doubles& affine, const MaskPair& mask, const py::dict& options,
                   const std::string& world, const py::object& progress) {
  const WorldSpace space = choice_of(world, kSpaces, "the space");
  const Volume image = volume_of(values, affine);
  SegmentRequest request = request_of(options, space);
  if (mask) request.labels = volume_of(mask->first, mask->second);
  TogetherResult result =
      run(progress, [&](const Progress& report) { return segment_together(image, request, report); });
  py::list surfaces;
  for (SegmentResult& found : result.surfaces) surfaces.append(tuple_of(std::move(found), space));
  return py::make_tuple(surfaces, result.first_meetings, result.rounds, result.most_withdrawn);
}

py::array_t<double> marked(const std::string& path, const std::string& world) {
  const WorldSpace space = choice_of(world, kSpaces, "the space");
  Points points;
  {
    const py::gil_scoped_release unlocked;
    points = in_space(read_marked_points(path), space);
  }
  return array_of(std::move(points));
}

py::array inside(const Mesh& fine, const std::string& world, const std::array<Index, 3>& size, const Doubles& affine,
                 bool parts) {
  const WorldSpace space = choice_of(world, kSpaces, "the space");
  const VolumeGrid grid = grid_of(size, affine);
  Volume volume = [&] {
    const py::gil_scoped_release unlocked;
    return inside_volume(in_space(Mesh(fine), space), grid, parts ? VoxelRule::Part : VoxelRule::Centre);
  }();
  return arrays_of(std::move(volume))[0];
}

}  // namespace

void bind_segment(py::module_& module) {
  module.def("segment", &segment);
  module.def("segment_together", &together);
  module.def("inside", &inside);
  module.def("read_marked_points", &marked);
}

}  // namespace batten::python
