/// The verb segment: from a label of a volume to a subdivision surface.
#include <fmt/format.h>

#include "batten/volume/inside_volume.h"
#include "batten/volume/marked_points.h"
#include "cli/input_output.h"
#include "cli/picture.h"
#include "cli/progress.h"
#include "cli/segment_output.h"
#include "cli/text.h"

namespace batten::cli {
namespace {

void write_inside(const SegmentArguments& arguments, const Mesh& fine, const VolumeGrid& grid) {
  if (arguments.inside.empty()) return;
  const Volume inside = inside_volume(fine, grid, arguments.parts ? VoxelRule::Part : VoxelRule::Centre);
  write_output_volume(arguments.inside, inside, !arguments.parts);
}

/// Frames in the space that was asked for.
FrameWatcher watch_in_space(const FrameWatcher& watch, WorldSpace space) {
  if (!watch) return {};
  return [watch, space](const SurfaceFrame& frame) {
    watch({frame.topology, frame.scheme, in_space(Points(frame.control), space)});
  };
}

nlohmann::ordered_json report_json(const SegmentArguments& arguments, const SegmentRequest& request,
                                   const SegmentResult& found) {
  nlohmann::ordered_json json = {
      {"mask", arguments.mask},          {"labels", arguments.labels},
      {"points", request.points.rows()}, {"slices", found.slices},
      {"left_out", found.left_out},      {"space", arguments.space == WorldSpace::Ras ? "RAS" : "LPS"}};
  add_surface(json, found);
  if (found.region) {
    json["seed"] = arguments.seed;
    json["region"] = {
        {"volume", found.region->volume}, {"open", found.region->open}, {"edges_beyond", found.region->edges_beyond}};
  }
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

/// What grew from the seed, and whether it leaks.
std::string region_text(const SeedRegion& region) {
  constexpr double kOpen = 0.06;
  std::string text = "the region has " + fixed_text(region.volume, 1) + " mm^3";
  if (region.open > kOpen)
    text += fmt::format("; {:.0f} % of its border has no edge: it may leak", 100.0 * region.open);
  return text;
}

std::string points_text(const SegmentRequest& request, const SegmentResult& found) {
  std::string text = count_of(request.points.rows(), "point", "points");
  if (found.slices > 0) text += " in " + count_of(found.slices, "slice", "slices");
  if (found.left_out > 0)
    text += fmt::format("; {} left out, deep in gaps that are narrower than points are apart", found.left_out);
  return text;
}

Table table_of(const SegmentRequest& request, const SegmentResult& found, const VolumeGrid& grid) {
  const Segmentation& result = found.surface;
  Table table;
  table.add("image", grid_text(grid));
  if (request.points.rows() > 0) table.add("points", points_text(request, found));
  if (found.region) table.add("seed", region_text(*found.region));
  table.add("surface",
            mesh_text(result.topology) +
                fmt::format("; genus {}, {}", result.genus, count_of(result.components, "component", "components")));
  if (result.dropped_parts > 0)
    table.add("", count_of(result.dropped_parts, "speck", "specks") + " of a few voxels left out");
  const std::string of_mask =
      found.agreement ? "; the mask has " + fixed_text(found.agreement->mask_volume, 1) + " mm^3" : "";
  table.add("volume", fmt::format("{} mm^3, area {} mm^2{}", fixed_text(found.measures.volume, 1),
                                  fixed_text(found.measures.area, 1), of_mask));
  if (found.agreement)
    table.add("agreement", fmt::format("Dice {:.4f}; mean distance {} mm to the surface, {} mm to the mask's border",
                                       found.agreement->dice, fixed_text(found.agreement->to_surface.mean, 3),
                                       fixed_text(found.agreement->to_border.mean, 3)));
  table.add("edges", fmt::format("{:.1f} % of the best within two voxels", 100.0 * found.edges.share()));
  if (found.measures.self_intersections > 0)
    table.add("", count_of(found.measures.self_intersections, "pair", "pairs") + " of triangles meet");
  return table;
}

/// The points of all files: those that 3D Slicer wrote say their world, the others are in that of --space.
Points read_points(const SegmentArguments& arguments, Job& job) {
  Points all(0, 3);
  for (const std::string& path : arguments.points) {
    const Points points =
        is_marked_points_path(path)
            ? read_marked_points(path)
            : in_space(read_file(path, "", arguments.common.quiet, &job.notes).points, arguments.space);
    all.conservativeResize(all.rows() + points.rows(), 3);
    all.bottomRows(points.rows()) = points;
  }
  return all;
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
  request.points = read_points(arguments, job);
  if (arguments.slices) take_contours(request, *arguments.slices);
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
  if (arguments.together) return run_segment_together(arguments, image, request, job);
  Evolution evolution(arguments.evolution, space_comment(arguments.space));
  request.surface.watch = watch_in_space(evolution.watcher(), arguments.space);
  ProgressBar bar("segmenting", arguments.common.quiet);
  const SegmentResult found = segment_volume(image, request, bar.callback());
  job.stages.finish("segment");
  const std::string written = write_in_space(arguments, arguments.common.output, found.surface, job);
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
