/// \file What the command line asked for, verb by verb, as plain data.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "batten/interpolate/interpolator.h"
#include "batten/mesh/repair.h"

namespace batten::cli {

/// The options that mean the same in every verb.
struct CommonArguments {
  std::string input;
  std::string output;
  std::string input_format;  ///< for stdin, or to overrule the extension
  std::string output_format;
  std::string report;
  std::string picture;
  std::optional<SchemeKind> scheme;
  std::optional<BoundaryRule> boundary;
  std::optional<CreaseMethod> crease_method;
  std::optional<TriangleRule> triangle_rule;
  double alpha = 0.0;
  bool triangulate = false;
  bool repair = false;
  bool quiet = false;
  bool ascii = false;
  int threads = 0;
};

struct InterpolateArguments {
  CommonArguments common;
  InterpolateOptions options;
  std::string plot;  ///< residual against iteration
  bool compare_methods = false;
};

struct SubdivideArguments {
  CommonArguments common;
  int levels = 1;
  bool limit = false;
};

struct RenderArguments {
  CommonArguments common;
  int levels = -1;  ///< -1: as many as make the picture smooth
  int width = 1600;
  int height = 1200;
  int samples = 2;
  std::optional<std::array<double, 3>> view;
  bool flat = false;     ///< draw the mesh itself, not its subdivision surface
  bool control = false;  ///< draw the control mesh as lines
  bool points = false;   ///< draw the vertices' limit positions as small spheres
};

struct RepairArguments {
  CommonArguments common;
  RepairOptions options;
};

int run_info(const CommonArguments& arguments);
int run_interpolate(const InterpolateArguments& arguments);
int run_subdivide(const SubdivideArguments& arguments);
int run_convert(const CommonArguments& arguments);
int run_repair(const RepairArguments& arguments);
int run_render(const RenderArguments& arguments);

}  // namespace batten::cli
