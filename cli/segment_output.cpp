#include "cli/segment_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/io/losses.h"
#include "batten/quantile.h"
#include "batten/tessellate/surface_mesh.h"
#include "batten/volume/slice.h"
#include "batten/volume/volume_file.h"
#include "cli/input_output.h"
#include "cli/picture.h"
#include "cli/text.h"
#ifdef BATTEN_WITH_RENDER
#include "batten/render/gray_picture.h"
#include "batten/render/panels.h"
#endif

namespace batten::cli {

Volume read_input_volume(const std::string& path) {
#ifdef BATTEN_WITH_VOLUMES
  return read_volume(path);
#else
  throw Error(ErrorCode::NotAvailable, path + ": this build reads no volumes; configure with BATTEN_WITH_VOLUMES=ON");
#endif
}

void write_output_volume(const std::string& path, const Volume& volume, bool bytes) {
#ifdef BATTEN_WITH_VOLUMES
  write_volume(path, volume, bytes ? VoxelType::Byte : VoxelType::Float);
#else
  (void)path;
  (void)volume;
  (void)bytes;
#endif
}

void draw_overlay(const SegmentArguments& arguments, const Mesh& fine, const Volume& image) {
  if (arguments.overlay.empty()) return;
#ifdef BATTEN_WITH_RENDER
  constexpr int kColumns = 4;
  constexpr double kPanelWidth = 400.0;
  constexpr double kText = 20.0;
  const std::vector<VolumeSlice> slices = slices_through(image, fine, kColumns);
  std::vector<double> numbers;
  double widest = 0.0;
  for (const VolumeSlice& slice : slices) {
    numbers.insert(numbers.end(), slice.numbers.data(), slice.numbers.data() + slice.numbers.size());
    widest = std::max({widest, slice.pixel_width * static_cast<double>(slice.numbers.cols()),
                       slice.pixel_height * static_cast<double>(slice.numbers.rows())});
  }
  GrayStyle style;
  style.black = quantile(numbers, 0.01);
  style.white = quantile(numbers, 0.99);
  style.scale = kPanelWidth / widest;
  std::vector<Panel> panels;
  for (const VolumeSlice& slice : slices) {
    const GrayImage gray{slice.numbers, slice.pixel_width, slice.pixel_height, slice.lines};
    panels.push_back({draw_gray(gray, style), slice.caption});
  }
  PictureStyle background;
  background.text_size = kText;
  write_png(arguments.overlay, in_rows(panels, kColumns, background));
#else
  (void)fine;
  (void)image;
  throw Error(ErrorCode::NotAvailable, "this build draws no pictures; configure with BATTEN_WITH_RENDER=ON");
#endif
}

namespace {

/// Formats whose programs draw what the file holds, and know no subdivision.
bool holds_fine_surface(const std::string& format) {
  return format == "glb" || format == "vtk" || format == "fsb" || format == "gii";
}

nlohmann::ordered_json distances_json(const DistanceSummary& summary) {
  return {{"mean", summary.mean}, {"rms", summary.rms}, {"percentile_95", summary.most_of_95}, {"max", summary.max}};
}

}  // namespace

std::string space_comment(WorldSpace space) { return space == WorldSpace::Ras ? "SPACE=RAS" : "SPACE=LPS"; }

std::string write_in_space(const SegmentArguments& arguments, const std::string& path, const Segmentation& result,
                           Job& job) {
  const CommonArguments& common = arguments.common;
  if (path.empty()) return {};
  const std::string format = file_format(path, common.output_format);
  if (format == "gii" && arguments.space == WorldSpace::Lps)
    throw Error(ErrorCode::BadArgument, path + ": GIFTI files are in RAS; leave --space out");
  const bool fine = arguments.levels >= 0 || holds_fine_surface(format);
  const int levels = arguments.levels >= 0 ? arguments.levels : std::min(3, picture_levels(result.topology));
  Mesh mesh = fine ? surface_mesh(result.topology, result.scheme, result.mesh, levels) : result.mesh;
  mesh = in_space(std::move(mesh), arguments.space);
  WriteOptions options{common.output_format, !common.ascii, UpAxis::Z};
  options.comment = space_comment(arguments.space);
  write_mesh(path, mesh, options);
  job.lost = find_losses(path, mesh, options);
  say_losses(path, job.lost, common.quiet);
  job.stages.finish("write");
  return fine ? fmt::format("the limit surface refined to {}, {}", count_of(levels, "level", "levels"), size_text(mesh))
              : "";
}

std::string grid_text(const VolumeGrid& grid) {
  return fmt::format("{} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm", grid.size[0], grid.size[1], grid.size[2],
                     grid.spacing(0), grid.spacing(1), grid.spacing(2));
}

void add_surface(nlohmann::ordered_json& json, const SegmentResult& found) {
  const Segmentation& result = found.surface;
  json["vertices"] = result.topology.vertex_count();
  json["faces"] = result.topology.face_count();
  json["scheme"] = scheme_json(result.scheme);
  json["genus"] = result.genus;
  json["components"] = result.components;
  json["dropped_parts"] = result.dropped_parts;
  json["rounds"] = result.rounds;
  json["cut_steps"] = result.cut_steps;
  json["volume"] = found.measures.volume;
  json["area"] = found.measures.area;
  json["self_intersections"] = found.measures.self_intersections;
  if (found.agreement) {
    json["mask_volume"] = found.agreement->mask_volume;
    json["dice"] = found.agreement->dice;
    json["border_to_surface"] = distances_json(found.agreement->to_surface);
    json["surface_to_border"] = distances_json(found.agreement->to_border);
  }
  json["edge_strength"] = {
      {"mean", found.edges.mean}, {"best_within_two_voxels", found.edges.best}, {"share", found.edges.share()}};
}

}  // namespace batten::cli
