#include "cli/job.h"

namespace batten::cli {

int run_convert(const CommonArguments& arguments) {
  Job job("convert", arguments);
  job.write(job.mesh);
  Table table;
  table.add("mesh", size_text(job.mesh));
  job.print(table);
  job.report({{"vertices", job.mesh.vertex_count()}, {"faces", job.mesh.face_count()}});
  return 0;
}

}  // namespace batten::cli
