#include "cli/surface_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "batten/io/io.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/picture.h"

namespace batten::cli {

std::string write_surface(const ControlMesh& control, int levels, Job& job) {
  const CommonArguments& common = job.common;
  const bool surface =
      !common.output.empty() && (levels >= 0 || file_format(common.output, common.output_format) == "glb");
  if (!surface) {
    job.write(control.mesh);
    return {};
  }
  const int depth = levels >= 0 ? levels : std::min(3, picture_levels(control.topology));
  const Mesh refined = surface_mesh(control.topology, control.scheme, control.mesh, depth,
                                    ProgressBar("refining", common.quiet).callback());
  job.write(refined);
  return fmt::format("the limit surface refined to {}, {}", count_of(depth, "level", "levels"), size_text(refined));
}

}  // namespace batten::cli
