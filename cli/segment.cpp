/// The verb segment: from a label of a volume to a subdivision surface.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/io/losses.h"
#include "batten/quantile.h"
#include "batten/tessellate/surface_mesh.h"
#include "batten/volume/inside_volume.h"
#include "batten/volume/segment_volume.h"
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

/// Formats whose programs draw what the file holds, and know no subdivision.
bool holds_fine_surface(const std::string& format) {
  return format == "glb" || format == "vtk" || format == "fsb" || format == "gii";
}

std::string space_comment(WorldSpace space) { return space == WorldSpace::Ras ? "SPACE=RAS" : "SPACE=LPS"; }

/// Frames in the space that was asked for.
FrameWatcher watch_in_space(const FrameWatcher& watch, WorldSpace space) {
  if (!watch) return {};
  return [watch, space](const SurfaceFrame& frame) {
    watch({frame.topology, frame.scheme, in_space(Points(frame.control), space)});
  };
}

/// The control mesh, or its surface, in the space that was asked for, which the file says.
std::string write_in_space(const SegmentArguments& arguments, const Segmentation& result, Job& job) {
  const CommonArguments& common = arguments.common;
  if (common.output.empty()) return {};
  const std::string format = file_format(common.output, common.output_format);
  if (format == "gii" && arguments.space == WorldSpace::Lps)
    throw Error(ErrorCode::BadArgument, common.output + ": GIFTI files are in RAS; leave --space out");
  const bool fine = arguments.levels >= 0 || holds_fine_surface(format);
  const int levels = arguments.levels >= 0 ? arguments.levels : std::min(3, picture_levels(result.topology));
  Mesh mesh = fine ? surface_mesh(result.topology, result.scheme, result.mesh, levels) : result.mesh;
  mesh = in_space(std::move(mesh), arguments.space);
  WriteOptions options{common.output_format, !common.ascii, UpAxis::Z};
  options.comment = space_comment(arguments.space);
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

nlohmann::ordered_json report_json(const SegmentArguments& arguments, const SegmentRequest& request,
                                   const SegmentResult& found) {
  const Segmentation& result = found.surface;
  nlohmann::ordered_json json = {{"mask", arguments.mask},
                                 {"labels", arguments.labels},
                                 {"points", request.points.rows()},
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
  if (found.region) {
    json["seed"] = arguments.seed;
    json["region"] = {
        {"volume", found.region->volume}, {"open", found.region->open}, {"edges_beyond", found.region->edges_beyond}};
  }
  json["edge_strength"] = {
      {"mean", found.edges.mean}, {"best_within_two_voxels", found.edges.best}, {"share", found.edges.share()}};
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

/// What grew from the seed, and whether it leaks.
std::string region_text(const SeedRegion& region) {
  constexpr double kOpen = 0.06;
  std::string text = fmt::format("the region has {:.1f} mm^3", region.volume);
  if (region.open > kOpen)
    text += fmt::format("; {:.0f} % of its border has no edge: it may leak", 100.0 * region.open);
  return text;
}

Table table_of(const SegmentRequest& request, const SegmentResult& found, const VolumeGrid& grid) {
  const Segmentation& result = found.surface;
  Table table;
  table.add("image", grid_text(grid));
  if (request.points.rows() > 0) table.add("points", count_of(request.points.rows(), "point", "points"));
  if (found.region) table.add("seed", region_text(*found.region));
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

SegmentRequest request_of(const SegmentArguments& arguments, Volume labels, Job& job) {
  const auto read_in_space = [&](const std::string& path) {
    return in_space(read_file(path, "", arguments.common.quiet, &job.notes), arguments.space);
  };
  SegmentRequest request;
  request.surface.scheme.kind = arguments.common.scheme.value_or(SchemeKind::CatmullClark);
  request.surface.vertices = arguments.vertices.value_or(request.surface.vertices);
  request.surface.genus = arguments.genus;
  request.surface.smoothing = arguments.smoothing;
  if (!arguments.mask.empty()) request.labels = std::move(labels);
  request.label = arguments.labels;
  if (!arguments.points.empty()) request.points = read_in_space(arguments.points).points;
  if (!arguments.seed.empty()) {
    Points seed(1, 3);
    seed << arguments.seed[0], arguments.seed[1], arguments.seed[2];
    request.seed = in_space(seed, arguments.space).row(0).transpose();
  }
  if (!arguments.numbers.empty()) request.seed_options.range = NumberRange{arguments.numbers[0], arguments.numbers[1]};
  if (!arguments.start.empty()) request.start = read_in_space(arguments.start);
  request.edges = arguments.edges;
  return request;
}

/// The picture and the frames; what the table says of these.
std::string draw_surface(const SegmentArguments& arguments, const SegmentRequest& request, const Segmentation& result,
                         const Evolution& evolution, Job& job) {
  const Points markers = in_space(Points(request.points), arguments.space);
  if (arguments.evolution.moments) {
    evolution.draw_moments(arguments.picture, markers, 0.0, job);
    job.stages.finish("picture");
  } else if (!arguments.picture.path.empty()) {
    Subject subject;
    subject.control = &result.mesh;
    subject.topology = result.topology;
    subject.scheme = result.scheme;
    subject.draw_control = true;
    subject.markers = request.points;
    draw(subject, arguments.picture, job);
    job.stages.finish("picture");
  }
  return evolution.write(arguments.picture, markers, 0.0, job);
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
  SegmentRequest request = request_of(arguments, std::move(labels), job);
  Evolution evolution(arguments.evolution, space_comment(arguments.space));
  request.surface.watch = watch_in_space(evolution.watcher(), arguments.space);
  ProgressBar bar("segmenting", arguments.common.quiet);
  const SegmentResult found = segment_volume(image, request, bar.callback());
  job.stages.finish("segment");
  const std::string written = write_in_space(arguments, found.surface, job);
  write_inside(arguments, found.measures.fine, image.grid);
  draw_overlay(arguments, found.measures.fine, image);
  const std::string frames = draw_surface(arguments, request, found.surface, evolution, job);
  Table table = table_of(request, found, image.grid);
  if (!written.empty()) table.add("written", written);
  if (!frames.empty()) table.add("frames", frames);
  job.print(table);
  job.report(report_json(arguments, request, found));
  return 0;
}

}  // namespace batten::cli
