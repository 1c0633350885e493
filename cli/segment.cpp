/// The verb segment: from a label of a volume to a subdivision surface.
#include "batten/volume/segment.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/io/losses.h"
#include "batten/quantile.h"
#include "batten/tessellate/surface_mesh.h"
#include "batten/volume/inside_volume.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/points_mask.h"
#include "batten/volume/segment_measures.h"
#include "batten/volume/slice.h"
#include "batten/volume/volume_file.h"
#include "cli/input_output.h"
#include "cli/job.h"
#include "cli/picture.h"
#include "cli/segment_arguments.h"
#ifdef BATTEN_WITH_RENDER
#include "batten/render/gray_picture.h"
#include "batten/render/panels.h"
#endif

namespace batten::cli {
namespace {

/// What a run has found.
struct Found {
  Segmentation surface;
  SurfaceMeasures measures;
  std::optional<MaskAgreement> agreement;
  EdgeStrength edges;
  Points points;
};

Volume read_input_volume(const std::string& path) {
#ifdef BATTEN_WITH_VOLUMES
  return read_volume(path);
#else
  throw Error(ErrorCode::NotAvailable, path + ": this build reads no volumes; configure with BATTEN_WITH_VOLUMES=ON");
#endif
}

void write_inside(const SegmentArguments& arguments, const Mesh& fine, const VolumeGrid& grid) {
  if (arguments.inside.empty()) return;
#ifdef BATTEN_WITH_VOLUMES
  const Volume inside = inside_volume(fine, grid, arguments.parts ? VoxelRule::Part : VoxelRule::Centre);
  write_volume(arguments.inside, inside, arguments.parts ? VoxelType::Float : VoxelType::Byte);
#else
  (void)fine;
  (void)grid;
#endif
}

/// Twelve slices, four in each direction.
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

/// The control mesh, or its surface, in the space that was asked for, which the file says.
std::string write_in_space(const SegmentArguments& arguments, const Segmentation& result, Job& job) {
  const CommonArguments& common = arguments.common;
  if (common.output.empty()) return {};
  const bool fine = arguments.levels >= 0 || file_format(common.output, common.output_format) == "glb";
  const int levels = arguments.levels >= 0 ? arguments.levels : std::min(3, picture_levels(result.topology));
  Mesh mesh = fine ? surface_mesh(result.topology, result.scheme, result.mesh, levels) : result.mesh;
  mesh.points = in_space(std::move(mesh.points), arguments.space);
  for (Attribute& attribute : mesh.attributes) {
    if (attribute.name == "normal" && arguments.space == WorldSpace::Lps) attribute.values.leftCols(2) *= -1.0;
  }
  WriteOptions options{common.output_format, !common.ascii, UpAxis::Z};
  options.comment = arguments.space == WorldSpace::Ras ? "SPACE=RAS" : "SPACE=LPS";
  write_mesh(common.output, mesh, options);
  job.lost = find_losses(common.output, mesh, options);
  say_losses(common.output, job.lost, common.quiet);
  job.stages.finish("write");
  return fine ? fmt::format("the limit surface refined to {}, {}", count_of(levels, "level", "levels"), size_text(mesh))
              : "";
}

std::string grid_text(const VolumeGrid& grid) {
  return fmt::format("{} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm", grid.size[0], grid.size[1], grid.size[2],
                     grid.spacing(0), grid.spacing(1), grid.spacing(2));
}

nlohmann::ordered_json distances_json(const DistanceSummary& summary) {
  return {{"mean", summary.mean}, {"rms", summary.rms}, {"percentile_95", summary.most_of_95}, {"max", summary.max}};
}

nlohmann::ordered_json report_json(const SegmentArguments& arguments, const Found& found) {
  const Segmentation& result = found.surface;
  nlohmann::ordered_json json = {{"mask", arguments.mask},
                                 {"labels", arguments.labels},
                                 {"points", found.points.rows()},
                                 {"space", arguments.space == WorldSpace::Ras ? "RAS" : "LPS"},
                                 {"vertices", result.topology.vertex_count()},
                                 {"faces", result.topology.face_count()},
                                 {"scheme", scheme_json(result.scheme)},
                                 {"genus", result.genus},
                                 {"components", result.components},
                                 {"dropped_parts", result.dropped_parts},
                                 {"rounds", result.rounds},
                                 {"cut_steps", result.cut_steps},
                                 {"volume", found.measures.volume},
                                 {"area", found.measures.area},
                                 {"self_intersections", found.measures.self_intersections}};
  if (found.agreement) {
    json["mask_volume"] = found.agreement->mask_volume;
    json["dice"] = found.agreement->dice;
    json["border_to_surface"] = distances_json(found.agreement->to_surface);
    json["surface_to_border"] = distances_json(found.agreement->to_border);
  }
  json["edge_strength"] = {
      {"mean", found.edges.mean}, {"best_within_two_voxels", found.edges.best}, {"share", found.edges.share()}};
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

Table table_of(const Found& found, const VolumeGrid& grid) {
  const Segmentation& result = found.surface;
  Table table;
  table.add("image", grid_text(grid));
  if (found.points.rows() > 0) table.add("points", count_of(found.points.rows(), "point", "points"));
  table.add("surface",
            mesh_text(result.topology) +
                fmt::format("; genus {}, {}", result.genus, count_of(result.components, "component", "components")));
  if (result.dropped_parts > 0)
    table.add("", count_of(result.dropped_parts, "speck", "specks") + " of a few voxels left out");
  const std::string of_mask =
      found.agreement ? fmt::format("; the mask has {:.1f} mm^3", found.agreement->mask_volume) : "";
  table.add("volume",
            fmt::format("{:.1f} mm^3, area {:.1f} mm^2{}", found.measures.volume, found.measures.area, of_mask));
  if (found.agreement)
    table.add("agreement",
              fmt::format("Dice {:.4f}; mean distance {:.3f} mm to the surface, {:.3f} mm to the mask's border",
                          found.agreement->dice, found.agreement->to_surface.mean, found.agreement->to_border.mean));
  table.add("edges", fmt::format("{:.1f} % of the best within two voxels", 100.0 * found.edges.share()));
  if (found.measures.self_intersections > 0)
    table.add("", count_of(found.measures.self_intersections, "pair", "pairs") + " of triangles meet");
  return table;
}

/// From points or labels to the surface, and its measures.
Found segmented(const SegmentArguments& arguments, const Volume& image, const Volume& labels, Job& job) {
  constexpr double kAlpha = 2.0;  // of the smoothing before edges are measured, 1/mm
  SegmentOptions options;
  options.scheme.kind = arguments.common.scheme.value_or(SchemeKind::CatmullClark);
  options.vertices = arguments.vertices.value_or(options.vertices);
  options.genus = arguments.genus;
  options.smoothing = arguments.smoothing;
  const bool with_points = !arguments.points.empty();
  Points points(0, 3);
  if (with_points)
    points = in_space(read_file(arguments.points, "", arguments.common.quiet, &job.notes).points, arguments.space);
  std::optional<Volume> mask;
  if (!with_points || !arguments.mask.empty())
    mask = label_mask(arguments.mask.empty() ? image : labels, arguments.labels);
  ProgressBar bar("segmenting", arguments.common.quiet);
  const bool drawn = with_points || arguments.edges;
  Segmentation surface = segment_mask(with_points ? points_mask(points) : *mask, options,
                                      progress_within(bar.callback(), 0.0, drawn ? 0.5 : 1.0));
  if (drawn) surface = segment_image(surface, image, points, {}, progress_within(bar.callback(), 0.5, 1.0));
  job.stages.finish("segment");
  SurfaceMeasures measures = measure_surface(surface.topology, surface.scheme, surface.mesh);
  std::optional<MaskAgreement> agreement;
  if (mask) agreement = compare_with_mask(measures.fine, *mask);
  const EdgeStrength edges = edge_strength(measures.fine, image, kAlpha);
  job.stages.finish("measure");
  return {std::move(surface), std::move(measures), agreement, edges, std::move(points)};
}

}  // namespace

int run_segment(const SegmentArguments& arguments) {
  Volume image;
  Volume labels;
  Job job(
      "segment", arguments.common,
      [&] {
        image = read_input_volume(arguments.common.input);
        if (!arguments.mask.empty()) labels = read_input_volume(arguments.mask);
      },
      UpAxis::Z);
  const Found found = segmented(arguments, image, labels, job);
  const std::string written = write_in_space(arguments, found.surface, job);
  write_inside(arguments, found.measures.fine, image.grid);
  draw_overlay(arguments, found.measures.fine, image);
  if (!arguments.picture.path.empty()) {
    Subject subject;
    subject.control = &found.surface.mesh;
    subject.topology = found.surface.topology;
    subject.scheme = found.surface.scheme;
    subject.draw_control = true;
    subject.markers = found.points;
    draw(subject, arguments.picture, job);
    job.stages.finish("picture");
  }
  Table table = table_of(found, image.grid);
  if (!written.empty()) table.add("written", written);
  job.print(table);
  job.report(report_json(arguments, found));
  return 0;
}

}  // namespace batten::cli
