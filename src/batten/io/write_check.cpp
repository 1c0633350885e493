#include "batten/io/write_check.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten::io {

namespace {

/// Throws Errors whose messages begin with the file's name.
struct Checker {
  const std::string& name;
  const Mesh& mesh;

  [[noreturn]] void fail(ErrorCode code, const std::string& what) const { throw Error(code, name + ": " + what); }

  /// The lowest i in [0, count) with is_bad(i), or -1.
  template <typename IsBad>
  static std::ptrdiff_t find(std::ptrdiff_t count, const IsBad& is_bad) {
    return parallel_reduce(
        count, std::ptrdiff_t{-1},
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          for (std::ptrdiff_t i = begin; i < end; ++i) {
            if (is_bad(i)) return i;
          }
          return std::ptrdiff_t{-1};
        },
        [](std::ptrdiff_t a, std::ptrdiff_t b) { return a >= 0 ? a : b; });
  }

  void points() const {
    const double* values = mesh.points.data();
    const auto bad = find(mesh.points.size(), [&](std::ptrdiff_t i) { return !std::isfinite(values[i]); });
    if (bad < 0) return;
    fail(ErrorCode::NotFinite, "vertex " + std::to_string(bad / 3) + " has a coordinate that is not finite");
  }

  void faces() const {
    const Buffer<Index>& offsets = mesh.face_offsets;
    if (offsets.empty() || offsets[0] != 0 || static_cast<std::size_t>(offsets.back()) != mesh.face_vertices.size()) {
      fail(ErrorCode::BadShape, "face_offsets must begin with 0 and end with the size of face_vertices");
    }
    const auto small =
        find(mesh.face_count(), [&](std::ptrdiff_t f) { return std::int64_t{offsets[f + 1]} - offsets[f] < 3; });
    if (small >= 0) {
      fail(ErrorCode::DegenerateFace, "face " + std::to_string(small) + " has fewer than three corners; remove it");
    }
    const auto corner_count = static_cast<std::ptrdiff_t>(mesh.face_vertices.size());
    const auto bad =
        find(corner_count, [&](std::ptrdiff_t i) { return !in(mesh.face_vertices[i], mesh.vertex_count()); });
    if (bad < 0) return;
    fail(ErrorCode::IndexOutOfRange, "corner " + std::to_string(bad) + " names vertex " +
                                         std::to_string(mesh.face_vertices[bad]) + ", but there are " +
                                         std::to_string(mesh.vertex_count()));
  }

  static bool in(Index index, std::ptrdiff_t count) { return index >= 0 && index < count; }

  void tags() const {
    const Index vertices = mesh.vertex_count();
    for (const Crease& crease : mesh.creases) {
      if (!in(crease.a, vertices) || !in(crease.b, vertices))
        fail(ErrorCode::IndexOutOfRange, "a crease names no vertex");
      sharpness(crease.sharpness);
    }
    for (const Corner& corner : mesh.corners) {
      if (!in(corner.vertex, vertices)) fail(ErrorCode::IndexOutOfRange, "a corner names no vertex");
      sharpness(corner.sharpness);
    }
    for (const Index hole : mesh.holes) {
      if (!in(hole, mesh.face_count())) fail(ErrorCode::IndexOutOfRange, "a hole names no face");
    }
  }

  void sharpness(double value) const {
    if (!(value >= 0)) fail(ErrorCode::NotFinite, "a sharpness is neither 0 nor above");
  }

  void attribute(const Attribute& attribute) const {
    const std::string called = "attribute '" + attribute.name + "'";
    const auto columns = attribute.values.cols();
    const bool fits = attribute.name == "uv"       ? columns == 2
                      : attribute.name == "normal" ? columns == 3
                      : attribute.name == "color"  ? columns == 3 || columns == 4
                                                   : true;
    if (!fits) fail(ErrorCode::BadShape, called + " cannot have " + std::to_string(columns) + " columns");
    if (!attribute.per_corner()) {
      if (attribute.values.rows() == mesh.points.rows()) return;
      fail(ErrorCode::BadShape, called + " has " + std::to_string(attribute.values.rows()) + " rows for " +
                                    std::to_string(mesh.points.rows()) + " vertices");
    }
    if (attribute.corner_rows.size() != mesh.face_vertices.size()) {
      fail(ErrorCode::BadShape, called + " must have one row number per corner");
    }
    const auto count = static_cast<std::ptrdiff_t>(attribute.corner_rows.size());
    const auto bad = find(count, [&](std::ptrdiff_t i) {
      return attribute.corner_rows[i] != -1 && !in(attribute.corner_rows[i], attribute.values.rows());
    });
    if (bad >= 0) fail(ErrorCode::IndexOutOfRange, called + ", corner " + std::to_string(bad) + ": no such row");
  }

  void text(const std::string& word) const {
    if (word.find_first_of("\r\n") != std::string::npos) fail(ErrorCode::BadArgument, "a name holds a line end");
  }

  void names() const {
    for (const std::string& library : mesh.material_libraries) text(library);
    Index before = 0;
    for (const Group& group : mesh.groups) {
      text(group.keyword);
      text(group.name);
      if (group.first_face < before || group.first_face > mesh.face_count()) {
        fail(ErrorCode::IndexOutOfRange, "groups must be in the order of their first faces");
      }
      before = group.first_face;
    }
  }
};

const Attribute* find_attribute(const Mesh& mesh, const std::string& name, bool per_corner) {
  const auto found = std::find_if(mesh.attributes.begin(), mesh.attributes.end(), [&](const Attribute& attribute) {
    return attribute.name == name && attribute.per_corner() == per_corner;
  });
  return found == mesh.attributes.end() ? nullptr : &*found;
}

}  // namespace

void require_writable(const std::string& name, const Mesh& mesh) {
  const Checker checker{name, mesh};
  checker.points();
  checker.faces();
  checker.tags();
  for (const Attribute& attribute : mesh.attributes) {
    checker.text(attribute.name);
    checker.attribute(attribute);
  }
  checker.names();
}

const Attribute* vertex_attribute(const Mesh& mesh, const std::string& attribute) {
  return find_attribute(mesh, attribute, false);
}

const Attribute* corner_attribute(const Mesh& mesh, const std::string& attribute) {
  return find_attribute(mesh, attribute, true);
}

CornerList corner_list(const Mesh& mesh, const std::string& attribute) {
  const Attribute* at_corners = corner_attribute(mesh, attribute);
  return {at_corners != nullptr ? at_corners : vertex_attribute(mesh, attribute)};
}

void require_finite(const std::string& name, const CornerList& list) {
  if (list.attribute == nullptr) return;
  const Values& values = list.attribute->values;
  const auto bad = Checker::find(values.size(), [&](std::ptrdiff_t i) { return !std::isfinite(values.data()[i]); });
  if (bad < 0) return;
  throw Error(ErrorCode::NotFinite, name + ": attribute '" + list.attribute->name + "', row " +
                                        std::to_string(bad / values.cols()) + ": a number is not finite");
}

}  // namespace batten::io
