#include "batten/io/formats.h"
#include "batten/io/text_output.h"
#include "batten/io/write_check.h"

namespace batten::io {

void write_xyz(OutputFile& file, const Mesh& mesh) {
  file.expect_rows(mesh.vertex_count());
  const Attribute* normal = vertex_attribute(mesh, "normal");
  write_rows<TextBuffer>(file, mesh.vertex_count(), [&](TextBuffer& out, std::ptrdiff_t row) {
    out.put(mesh.points(row, 0)).put(' ').put(mesh.points(row, 1)).put(' ').put(mesh.points(row, 2));
    if (normal != nullptr) out.put_row(normal->values.row(row));
    out.put('\n');
  });
}

}  // namespace batten::io
