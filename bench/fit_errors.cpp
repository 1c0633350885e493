// The error of fits against their control points, both schemes, beside a published one, as a table and a plot:
//   fit_errors cactus.xyz 0.090 picture.svg 50 70 100 150 200
// The error is the RMS distance of the points from the surface in % of the diagonal of their box.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include "batten/fit/fit_surface.h"
#include "batten/fit/mesh_samples.h"
#include "batten/io/io.h"
#include "batten/render/plot.h"

namespace {

using namespace batten;

/// Where a falling line reaches a height, straight between its points on logarithmic axes; NaN where it does not.
double reached_at(const PlotLine& line, double height) {
  for (std::size_t i = 1; i < line.x.size(); ++i) {
    if (!(line.y[i - 1] > height) || line.y[i] > height) continue;
    const double share = std::log(line.y[i - 1] / height) / std::log(line.y[i - 1] / line.y[i]);
    return line.x[i - 1] * std::pow(line.x[i] / line.x[i - 1], share);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

PlotLine errors_of(const Mesh& mesh, SchemeKind kind, const std::vector<Index>& counts) {
  PlotLine line;
  line.name = kind == SchemeKind::Loop ? "Loop" : "Catmull-Clark";
  for (const Index count : counts) {
    FitOptions options;
    options.scheme.kind = kind;
    options.vertices = count;
    const PointCloud cloud = cloud_of_mesh(mesh, count);
    const FitResult result = fit_surface(cloud, options);
    const double diagonal = (cloud.points.colwise().maxCoeff() - cloud.points.colwise().minCoeff()).norm();
    line.x.push_back(result.mesh.vertex_count());
    line.y.push_back(100.0 * result.report.to_surface.rms / diagonal);
    std::printf("%-14s %6d control points  rms %.4f %%  max %.3f %%  %d unsound  %.1f s\n", line.name.c_str(),
                result.mesh.vertex_count(), line.y.back(), 100.0 * result.report.to_surface.max / diagonal,
                result.report.unsound, result.report.seconds);
    std::fflush(stdout);
  }
  return line;
}

void run(int count, char** words) {
  const Mesh mesh = read_mesh(words[1]);
  const double published = std::atof(words[2]);
  std::vector<Index> counts;
  for (int i = 4; i < count; ++i) counts.push_back(std::atoi(words[i]));
  Plot plot;
  plot.x_label = "control points";
  plot.y_label = "RMS distance, % of the box's diagonal";
  plot.log_y = true;
  for (const SchemeKind kind : {SchemeKind::Loop, SchemeKind::CatmullClark}) {
    plot.lines.push_back(errors_of(mesh, kind, counts));
    std::printf("%-14s reaches %.3f %% with %.0f control points\n", plot.lines.back().name.c_str(), published,
                reached_at(plot.lines.back(), published));
  }
  plot.lines.push_back({"Subdivfit", {plot.lines[0].x.front(), plot.lines[0].x.back()}, {published, published}, true});
  write_plot(words[3], plot);
}

}  // namespace

int main(int count, char** words) {
  if (count < 6) {
    std::fprintf(stderr, "usage: fit_errors POINTS PUBLISHED_RMS PICTURE COUNT COUNT...\n");
    return 2;
  }
  try {
    run(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fit_errors: %s\n", error.what());
    return 1;
  }
  return 0;
}
