/// The verb segment with --together: a surface for each of several labels, apart from each other.
#include "batten/volume/segment_together.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include "batten/mesh/joined_mesh.h"
#include "batten/volume/inside_volume.h"
#include "batten/volume/label_mask.h"
#include "cli/picture.h"
#include "cli/progress.h"
#include "cli/segment_output.h"

namespace batten::cli {
namespace {

/// organ.obj of label 71 becomes organ-71.obj.
std::string path_of_label(const std::string& path, double label) {
  const std::filesystem::path whole(path);
  const std::string name = whole.stem().string() + "-" + label_text(label) + whole.extension().string();
  return (whole.parent_path() / name).string();
}

/// The label's number where the centre of a voxel of the image is inside its surface.
void write_insides(const SegmentArguments& arguments, const TogetherResult& result, const VolumeGrid& grid) {
  if (arguments.inside.empty()) return;
  Volume sum{grid, Buffer<float>(static_cast<std::size_t>(grid.count()), 0.0F)};
  bool bytes = true;
  for (std::size_t i = 0; i < result.surfaces.size(); ++i) {
    const double label = arguments.labels[i];
    bytes = bytes && label == std::floor(label) && label >= 0.0 && label <= 255.0;
    const Volume inside = inside_volume(result.surfaces[i].measures.fine, grid, VoxelRule::Centre);
    for (std::size_t voxel = 0; voxel < sum.values.size(); ++voxel) {
      if (inside.values[voxel] > 0.5F) sum.values[voxel] = static_cast<float>(label);
    }
  }
  write_output_volume(arguments.inside, sum, bytes);
}

/// The control meshes as one, each in a colour of its own.
Mesh coloured(const TogetherResult& result) {
  constexpr std::array<std::array<double, 3>, 6> kColors{{{0.90, 0.62, 0.35},
                                                          {0.36, 0.60, 0.82},
                                                          {0.50, 0.72, 0.40},
                                                          {0.80, 0.45, 0.60},
                                                          {0.90, 0.82, 0.40},
                                                          {0.55, 0.50, 0.80}}};
  std::vector<Mesh> meshes;
  for (const SegmentResult& found : result.surfaces) meshes.push_back(found.surface.mesh);
  Mesh all = joined_mesh(meshes);
  Values colors(all.points.rows(), 3);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::array<double, 3>& color = kColors[i % kColors.size()];
    colors.middleRows(row, meshes[i].points.rows()).rowwise() = Eigen::RowVector3d(color[0], color[1], color[2]);
    row += meshes[i].points.rows();
  }
  all.attributes.push_back({"color", std::move(colors), {}});
  return all;
}

void draw_together(const SegmentArguments& arguments, const TogetherResult& result, Job& job) {
  if (arguments.picture.path.empty()) return;
  const Mesh control = coloured(result);
  Subject subject;
  subject.control = &control;
  subject.topology = Topology(control);
  subject.scheme = result.surfaces.front().surface.scheme;
  draw(subject, arguments.picture, job);
  job.stages.finish("picture");
}

Table table_of(const SegmentArguments& arguments, const TogetherResult& result, const VolumeGrid& grid) {
  Table table;
  table.add("image", grid_text(grid));
  for (std::size_t i = 0; i < result.surfaces.size(); ++i) {
    const SegmentResult& found = result.surfaces[i];
    table.add("label " + label_text(arguments.labels[i]),
              fmt::format("{}; genus {}; {} mm^3, area {} mm^2; Dice {:.4f}, mean distance {} mm",
                          mesh_text(found.surface.topology), found.surface.genus, fixed_text(found.measures.volume, 1),
                          fixed_text(found.measures.area, 1), found.agreement->dice,
                          fixed_text(found.agreement->to_surface.mean, 3)));
    if (found.measures.self_intersections > 0)
      table.add("", count_of(found.measures.self_intersections, "pair", "pairs") + " of its triangles meet");
  }
  table.add("apart",
            result.rounds == 0
                ? "the surfaces do not meet"
                : fmt::format("the surfaces do not meet; alone, {} of triangles did: there the border was moved "
                              "inwards, by at most {:.2f} mm, in {}",
                              count_of(result.first_meetings, "pair", "pairs"), result.most_withdrawn,
                              count_of(result.rounds, "round", "rounds")));
  return table;
}

nlohmann::ordered_json json_of(const SegmentArguments& arguments, const TogetherResult& result) {
  nlohmann::ordered_json surfaces = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < result.surfaces.size(); ++i) {
    nlohmann::ordered_json json = {{"label", arguments.labels[i]}};
    add_surface(json, result.surfaces[i]);
    surfaces.push_back(std::move(json));
  }
  return {{"mask", arguments.mask},
          {"labels", arguments.labels},
          {"space", arguments.space == WorldSpace::Ras ? "RAS" : "LPS"},
          {"surfaces", std::move(surfaces)},
          {"together",
           {{"first_meetings", result.first_meetings},
            {"rounds", result.rounds},
            {"most_withdrawn", result.most_withdrawn}}},
          {"peak_memory_bytes", peak_memory_bytes()}};
}

}  // namespace

int run_segment_together(const SegmentArguments& arguments, const Volume& image, const SegmentRequest& request,
                         Job& job) {
  ProgressBar bar("segmenting", arguments.common.quiet);
  const TogetherResult result = segment_together(image, request, bar.callback());
  job.stages.finish("segment");
  std::vector<Mesh> fine;
  std::vector<std::string> written;
  for (std::size_t i = 0; i < result.surfaces.size(); ++i) {
    fine.push_back(result.surfaces[i].measures.fine);
    if (arguments.common.output.empty()) continue;
    written.push_back(path_of_label(arguments.common.output, arguments.labels[i]));
    write_in_space(arguments, written.back(), result.surfaces[i].surface, job);
  }
  write_insides(arguments, result, image.grid);
  draw_overlay(arguments, joined_mesh(fine), image);
  draw_together(arguments, result, job);
  Table table = table_of(arguments, result, image.grid);
  if (!written.empty()) table.add("written", fmt::format("{}", fmt::join(written, ", ")));
  job.print(table);
  job.report(json_of(arguments, result));
  return 0;
}

}  // namespace batten::cli
