#include "batten/io/formats.h"
#include "batten/io/text_output.h"

namespace batten::io {

void write_off(OutputFile& file, const Mesh& mesh) {
  file.expect_rows(std::ptrdiff_t{mesh.vertex_count()} + mesh.face_count());
  TextBuffer header;
  header.put("OFF\n").put(mesh.vertex_count()).put(' ').put(mesh.face_count()).put(" 0\n");
  file.write(header.text());
  write_rows<TextBuffer>(file, mesh.vertex_count(), [&](TextBuffer& out, std::ptrdiff_t row) {
    out.put(mesh.points(row, 0)).put(' ').put(mesh.points(row, 1)).put(' ').put(mesh.points(row, 2)).put('\n');
  });
  write_face_rows(file, mesh);
}

}  // namespace batten::io
