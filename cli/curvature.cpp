#include "cli/curvature.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "batten/expand/color_ramp.h"
#include "batten/io/io.h"
#include "batten/quantile.h"
#include "cli/input_output.h"
#include "cli/text.h"

namespace batten::cli {

namespace {

using Json = nlohmann::ordered_json;

/// As a colour bar's ends are chosen.
constexpr double kOutliers = 0.02;

struct Spread {
  double lowest = 0.0;
  double low = 0.0;  ///< but for the outliers
  double median = 0.0;
  double high = 0.0;
  double highest = 0.0;
  Index count = 0;
};

Spread spread_of(const Scalars& numbers) {
  std::vector<double> finite;
  std::copy_if(numbers.begin(), numbers.end(), std::back_inserter(finite), [](double x) { return std::isfinite(x); });
  if (finite.empty()) return {};
  return {quantile(finite, 0.0), quantile(finite, kOutliers),
          quantile(finite, 0.5), quantile(finite, 1.0 - kOutliers),
          quantile(finite, 1.0), static_cast<Index>(finite.size())};
}

std::string spread_text(const Spread& spread) {
  if (spread.count == 0) return "none at any vertex";
  return fmt::format("{:.4g} to {:.4g}, median {:.4g}; {:.4g} to {:.4g} but for 2 % at each end", spread.lowest,
                     spread.highest, spread.median, spread.low, spread.high);
}

Json spread_json(const Spread& spread, const Scalars& numbers) {
  return {{"lowest", spread.lowest}, {"low", spread.low},         {"median", spread.median},
          {"high", spread.high},     {"highest", spread.highest}, {"values", numbers}};
}

Scalars without_nan(const Scalars& numbers) {
  return numbers.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
}

/// Blue for hollow, grey for flat, red for bulging; the ends' colours from `reach` on.
Values signed_colors(const Scalars& numbers, double reach) {
  const ColorRamp ramp(
      {{0.23, 0.30, 0.75}, {0.62, 0.74, 1.0}, {0.87, 0.87, 0.87}, {0.96, 0.60, 0.48}, {0.71, 0.02, 0.15}});
  Values colors(numbers.size(), 3);
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    const double x = std::isfinite(numbers[i]) && reach > 0.0 ? numbers[i] / reach : 0.0;
    colors.row(i) = ramp.color(0.5 + 0.5 * std::clamp(x, -1.0, 1.0));
  }
  return colors;
}

void put(Mesh& mesh, Attribute attribute) {
  std::erase_if(mesh.attributes, [&](const Attribute& other) { return other.name == attribute.name; });
  mesh.attributes.push_back(std::move(attribute));
}

}  // namespace

VertexCurvature measure_curvature(const Topology& topology, const Scheme& scheme, const Mesh& mesh) {
  return limit_curvature(LimitSurface(topology, scheme, mesh.points), topology);
}

void describe_curvature(const VertexCurvature& curvature, Table& table, Json& json) {
  const Spread mean = spread_of(curvature.mean);
  const Spread gaussian = spread_of(curvature.gaussian);
  table.add("mean curvature", spread_text(mean));
  table.add("Gaussian", spread_text(gaussian));
  json["mean_curvature"] = spread_json(mean, curvature.mean);
  json["gaussian_curvature"] = spread_json(gaussian, curvature.gaussian);
}

void write_curvature(const CommonArguments& arguments, const VertexCurvature& curvature, Mesh mesh, Table& table,
                     Json& json) {
  if (arguments.output.empty()) return;
  const std::string format = file_format(arguments.output, arguments.output_format);
  if (format == "obj" || format == "glb") {
    const Spread mean = spread_of(curvature.mean);
    const double reach = std::max(std::abs(mean.low), std::abs(mean.high));
    put(mesh, {"color", signed_colors(curvature.mean, reach), {}});
    table.add("colours",
              fmt::format("the mean curvature, blue for {:.4g} and below, red for {:.4g} and above", -reach, reach));
  }
  if (format != "obj") {
    put(mesh, {"mean_curvature", without_nan(curvature.mean), {}});
    put(mesh, {"gaussian_curvature", without_nan(curvature.gaussian), {}});
  }
  write_output(arguments, mesh, up_axis_for(arguments, mesh));
  json["output"] = arguments.output;
  json["lost"] = tell_losses(arguments, mesh);
}

}  // namespace batten::cli
