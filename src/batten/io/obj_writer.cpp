#include <algorithm>
#include <cmath>

#include "batten/io/formats.h"
#include "batten/io/text_output.h"
#include "batten/io/write_check.h"

namespace batten::io {

namespace {

void write_points(OutputFile& file, const Mesh& mesh) {
  const Attribute* color = vertex_attribute(mesh, "color");
  write_rows<TextBuffer>(file, mesh.vertex_count(), [&](TextBuffer& out, std::ptrdiff_t i) {
    out.put('v').put_row(mesh.points.row(i));
    if (color != nullptr) out.put_row(color->values.row(i));
    out.put('\n');
  });
}

void write_list(OutputFile& file, std::string_view keyword, const CornerList& list) {
  if (list.attribute == nullptr) return;
  const Values& values = list.attribute->values;
  write_rows<TextBuffer>(file, values.rows(),
                         [&](TextBuffer& out, std::ptrdiff_t i) { out.put(keyword).put_row(values.row(i)).put('\n'); });
}

/// Infinity has no text that reads back. Any sharpness from kInfiniteSharpness on means the same.
double finite_sharpness(double sharpness) { return std::isinf(sharpness) ? double{kInfiniteSharpness} : sharpness; }

void put_settings(TextBuffer& out, const Mesh& mesh) {
  if (mesh.boundary) {
    const Index rule = *mesh.boundary == BoundaryRule::None ? 0 : *mesh.boundary == BoundaryRule::EdgeAndCorner ? 1 : 2;
    out.put("t interpolateboundary 1/0/0 ").put(rule).put('\n');
  }
  if (mesh.crease_method) {
    const bool chaikin = *mesh.crease_method == CreaseMethod::Chaikin;
    out.put("t creasemethod 0/0/1 ").put(std::string_view(chaikin ? "chaikin" : "normal")).put('\n');
  }
  if (mesh.triangle_rule) {
    const bool smooth = *mesh.triangle_rule == TriangleRule::Smooth;
    out.put("t smoothtriangles 0/0/1 ").put(std::string_view(smooth ? "smooth" : "catmark")).put('\n');
  }
  if (mesh.face_varying) {
    out.put("t facevaryinginterpolateboundary 1/0/0 ").put(static_cast<Index>(*mesh.face_varying)).put('\n');
  }
}

void write_tags(OutputFile& file, const Mesh& mesh) {
  TextBuffer settings;
  put_settings(settings, mesh);
  file.write(settings.text());
  write_rows<TextBuffer>(file, static_cast<std::ptrdiff_t>(mesh.creases.size()),
                         [&](TextBuffer& out, std::ptrdiff_t i) {
                           const Crease& crease = mesh.creases[i];
                           out.put("t crease 2/1/0 ").put(crease.a).put(' ').put(crease.b).put(' ');
                           out.put(finite_sharpness(crease.sharpness)).put('\n');
                         });
  write_rows<TextBuffer>(
      file, static_cast<std::ptrdiff_t>(mesh.corners.size()), [&](TextBuffer& out, std::ptrdiff_t i) {
        const Corner& corner = mesh.corners[i];
        out.put("t corner 1/1/0 ").put(corner.vertex).put(' ').put(finite_sharpness(corner.sharpness)).put('\n');
      });
  write_rows<TextBuffer>(file, static_cast<std::ptrdiff_t>(mesh.holes.size()), [&](TextBuffer& out, std::ptrdiff_t i) {
    out.put("t hole 1/0/0 ").put(mesh.holes[i]).put('\n');
  });
}

/// Writes the groups that begin at faces up to `face`. Returns the next group.
class FaceWriter {
 public:
  explicit FaceWriter(const Mesh& mesh)
      : mesh_(mesh), uv_(corner_list(mesh, "uv")), normal_(corner_list(mesh, "normal")) {}

  void put(TextBuffer& out, Index face) const {
    put_groups(out, face);
    if (face == mesh_.face_count()) return;
    out.put('f');
    for (Index corner = mesh_.face_offsets[face]; corner < mesh_.face_offsets[face + 1]; ++corner) {
      out.put(' ').put(mesh_.face_vertices[corner] + 1);
      const Index uv = uv_.row(mesh_, corner);
      const Index normal = normal_.row(mesh_, corner);
      if (uv >= 0 || normal >= 0) out.put('/');
      if (uv >= 0) out.put(uv + 1);
      if (normal >= 0) out.put('/').put(normal + 1);
    }
    out.put('\n');
  }

 private:
  void put_groups(TextBuffer& out, Index face) const {
    const auto first = std::lower_bound(mesh_.groups.begin(), mesh_.groups.end(), face,
                                        [](const Group& group, Index value) { return group.first_face < value; });
    for (auto group = first; group != mesh_.groups.end() && group->first_face == face; ++group) {
      out.put(group->keyword);
      if (!group->name.empty()) out.put(' ').put(group->name);
      out.put('\n');
    }
  }

  const Mesh& mesh_;
  CornerList uv_;
  CornerList normal_;
};

}  // namespace

void write_obj(OutputFile& file, const Mesh& mesh, const std::vector<std::string>& libraries) {
  const auto rows_of = [](const CornerList& list) {
    return list.attribute == nullptr ? 0 : list.attribute->values.rows();
  };
  file.expect_rows(mesh.vertex_count() + rows_of(corner_list(mesh, "uv")) + rows_of(corner_list(mesh, "normal")) +
                   static_cast<std::ptrdiff_t>(mesh.creases.size()) + mesh.face_count());
  for (const std::string& library : libraries) file.write("mtllib " + library + "\n");
  write_points(file, mesh);
  write_list(file, "vt", corner_list(mesh, "uv"));
  write_list(file, "vn", corner_list(mesh, "normal"));
  write_tags(file, mesh);
  const FaceWriter faces(mesh);
  // The extra row is for groups that begin after the last face.
  write_rows<TextBuffer>(file, std::ptrdiff_t{mesh.face_count()} + 1,
                         [&](TextBuffer& out, std::ptrdiff_t face) { faces.put(out, static_cast<Index>(face)); });
}

}  // namespace batten::io
