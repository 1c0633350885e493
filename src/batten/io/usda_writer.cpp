#include <algorithm>

#include "batten/error.h"
#include "batten/io/crease_chains.h"
#include "batten/io/drawn_normals.h"
#include "batten/io/face_sets.h"
#include "batten/io/float_frame.h"
#include "batten/io/formats.h"
#include "batten/io/usda_text.h"
#include "batten/io/write_check.h"

namespace batten::io {

namespace {

/// USD's surfaces have OpenSubdiv's default creases only. Chaikin's creases differ where sharpness fades.
void require_uniform_creases(const std::string& name, const Mesh& mesh) {
  if (mesh.crease_method != CreaseMethod::Chaikin) return;
  const bool fades = std::any_of(mesh.creases.begin(), mesh.creases.end(), [](const Crease& crease) {
    return crease.sharpness > 0.0 && crease.sharpness < double{kInfiniteSharpness};
  });
  if (!fades) return;
  throw Error(ErrorCode::BadArgument,
              name + ": USD has no Chaikin creases, and this surface depends on them; take uniform creases, or obj");
}

/// USD's names of the FaceVaryingRules.
constexpr const char* kLinearInterpolations[] = {"none",         "cornersOnly", "cornersPlus1",
                                                 "cornersPlus2", "boundaries",  "all"};

class UsdaMesh {
 public:
  UsdaMesh(OutputFile& file, const Mesh& mesh, UpAxis up)
      : mesh_(mesh), up_(up), name_(file.name()), frame_(float_frame(name_, mesh.points)), out_(file) {
    for (const Attribute& attribute : mesh.attributes) require_finite(name_, {&attribute});
    require_uniform_creases(name_, mesh);
    std::ptrdiff_t rows =
        mesh.vertex_count() + mesh.face_count() + static_cast<std::ptrdiff_t>(mesh.face_vertices.size());
    for (const Attribute& attribute : mesh.attributes) {
      rows += attribute.values.rows() + static_cast<std::ptrdiff_t>(attribute.corner_rows.size());
    }
    file.expect_rows(rows);
  }

  void write() {
    out_.line("#usda 1.0");
    out_.line("(");
    out_.line("    defaultPrim = \"surface\"");
    out_.line("    doc = \"Written by Batten\"");
    out_.line("    metersPerUnit = 1");
    out_.line(std::string("    upAxis = ") + (up_ == UpAxis::Z ? "\"Z\"" : "\"Y\""));
    out_.line(")\n");
    out_.open("def Mesh \"surface\"");
    write_faces();
    write_points();
    if (is_usda_polygonal(mesh_)) {
      out_.line("uniform token subdivisionScheme = \"none\"");
      write_normals();
    } else {
      write_scheme();
      write_tags();
    }
    out_.line("uniform bool doubleSided = 1");
    write_attributes();
    write_materials();
    out_.close();
  }

 private:
  void write_faces() {
    out_.array("int[] faceVertexCounts", mesh_.face_count(),
               [&](TextBuffer& out, std::ptrdiff_t i) { out.put(mesh_.face_size(static_cast<Index>(i))); });
    indices("int[] faceVertexIndices", mesh_.face_vertices);
  }

  template <typename Indices>
  void indices(const std::string& declaration, const Indices& values) {
    out_.array(declaration, static_cast<std::ptrdiff_t>(values.size()),
               [&](TextBuffer& out, std::ptrdiff_t i) { out.put(Index{values[i]}); });
  }

  void write_points() {
    out_.array("point3f[] points", mesh_.vertex_count(), [&](TextBuffer& out, std::ptrdiff_t i) {
      UsdaWriter::put_tuple(out, Eigen::RowVector3d(mesh_.points.row(i) - frame_.origin));
    });
    out_.array("float3[] extent", mesh_.vertex_count() > 0 ? 2 : 0, [&](TextBuffer& out, std::ptrdiff_t i) {
      UsdaWriter::put_tuple(out, i == 0 ? frame_.low : frame_.high);
    });
    write_transform();
  }

  /// The last operation of the order comes first.
  void write_transform() {
    const bool turns = up_ != UpAxis::Y && up_ != UpAxis::Z;
    const bool moves = !frame_.origin.isZero(0.0);
    if (turns) {
      const Eigen::Matrix3d turned = to_y_up(up_);
      TextBuffer rows;
      for (int axis = 0; axis < 3; ++axis) {
        rows.put(std::string_view(axis == 0 ? "( " : ", "));
        UsdaWriter::put_tuple(rows, Eigen::RowVector4d(turned(0, axis), turned(1, axis), turned(2, axis), 0.0));
      }
      out_.line("matrix4d xformOp:transform = " + std::string(rows.text()) + ", (0, 0, 0, 1) )");
    }
    if (moves) {
      TextBuffer origin;
      UsdaWriter::put_tuple(origin, frame_.origin);
      out_.line("double3 xformOp:translate = " + std::string(origin.text()));
    }
    if (!turns && !moves) return;
    const std::string turn = turns ? "\"xformOp:transform\"" : "";
    const std::string move = moves ? "\"xformOp:translate\"" : "";
    out_.line("uniform token[] xformOpOrder = [" + turn + (turns && moves ? ", " : "") + move + "]");
  }

  void write_scheme() {
    const SchemeKind kind = mesh_.scheme.value_or(all_triangles(mesh_) ? SchemeKind::Loop : SchemeKind::CatmullClark);
    const BoundaryRule boundary = mesh_.boundary.value_or(BoundaryRule::EdgeOnly);
    const std::string rule = boundary == BoundaryRule::None       ? "none"
                             : boundary == BoundaryRule::EdgeOnly ? "edgeOnly"
                                                                  : "edgeAndCorner";
    const bool smooth = mesh_.triangle_rule == TriangleRule::Smooth;
    out_.line(std::string("uniform token subdivisionScheme = ") +
              (kind == SchemeKind::Loop ? "\"loop\"" : "\"catmullClark\""));
    out_.line("token interpolateBoundary = \"" + rule + "\"");
    const auto linear = static_cast<std::size_t>(mesh_.face_varying.value_or(FaceVaryingRule::All));
    out_.line(std::string("token faceVaryingLinearInterpolation = \"") + kLinearInterpolations[linear] + "\"");
    out_.line(std::string("token triangleSubdivisionRule = ") + (smooth ? "\"smooth\"" : "\"catmullClark\""));
  }

  void write_tags() {
    const std::vector<CreaseChain> chains = crease_chains(mesh_.creases);
    std::vector<Index> vertices;
    for (const CreaseChain& chain : chains) {
      vertices.insert(vertices.end(), chain.vertices.begin(), chain.vertices.end());
    }
    const auto chain_count = static_cast<std::ptrdiff_t>(chains.size());
    const auto corner_count = static_cast<std::ptrdiff_t>(mesh_.corners.size());
    indices("int[] creaseIndices", vertices);
    out_.array("int[] creaseLengths", chain_count,
               [&](TextBuffer& out, std::ptrdiff_t i) { out.put(static_cast<Index>(chains[i].vertices.size())); });
    out_.array("float[] creaseSharpnesses", chain_count,
               [&](TextBuffer& out, std::ptrdiff_t i) { out.put(chains[i].sharpness); });
    out_.array("int[] cornerIndices", corner_count,
               [&](TextBuffer& out, std::ptrdiff_t i) { out.put(mesh_.corners[i].vertex); });
    out_.array("float[] cornerSharpnesses", corner_count, [&](TextBuffer& out, std::ptrdiff_t i) {
      out.put(std::min(mesh_.corners[i].sharpness, double{kInfiniteSharpness}));
    });
    indices("int[] holeIndices", mesh_.holes);
  }

  void write_normals() {
    const DrawnNormals normals(name_, mesh_, hidden_faces(mesh_));
    const auto at = [&](std::ptrdiff_t count, bool corners) {
      const std::string metadata = corners ? "interpolation = \"faceVarying\"" : "interpolation = \"vertex\"";
      const auto put = [&](TextBuffer& out, std::ptrdiff_t i) {
        UsdaWriter::put_tuple(out,
                              corners ? normals.at(static_cast<Index>(i)) : normals.at_vertex(static_cast<Index>(i)));
      };
      out_.array("normal3f[] normals", count, put, metadata);
    };
    if (corner_attribute(mesh_, "normal") != nullptr) {
      at(static_cast<std::ptrdiff_t>(mesh_.face_vertices.size()), true);
    } else {
      at(mesh_.vertex_count(), false);
    }
  }

  void write_attributes() {
    std::set<std::string> taken{"st", "displayColor", "displayOpacity"};
    for (const Attribute& attribute : mesh_.attributes) {
      const Eigen::Index columns = attribute.values.cols();
      if (attribute.name == "normal") continue;
      if (corner_list(mesh_, attribute.name).attribute == &attribute && attribute.name == "uv") {
        write_primvar("texCoord2f[] primvars:st", attribute, 0, 2);
      } else if (corner_list(mesh_, attribute.name).attribute == &attribute && attribute.name == "color") {
        write_primvar("color3f[] primvars:displayColor", attribute, 0, 3);
        if (columns == 4) write_primvar("float[] primvars:displayOpacity", attribute, 3, 1);
      } else {
        const std::string type = columns >= 2 && columns <= 4 ? "double" + std::to_string(columns) : "double";
        write_primvar(type + "[] primvars:" + usda_identifier(attribute.name, taken), attribute, 0, columns);
      }
    }
  }

  /// Writes the columns [first, first + count) of an attribute. A corner without a row gets a row of zeros, added at
  /// the end.
  void write_primvar(const std::string& declaration, const Attribute& attribute, Eigen::Index first,
                     Eigen::Index count) {
    const auto rows = static_cast<std::ptrdiff_t>(attribute.values.rows());
    const Buffer<Index>& corners = attribute.corner_rows;
    const bool gaps = std::find(corners.begin(), corners.end(), -1) != corners.end();
    std::string metadata = attribute.per_corner() ? "interpolation = \"faceVarying\"" : "interpolation = \"vertex\"";
    const bool flat = count > 4;
    if (flat) metadata = "elementSize = " + std::to_string(count) + "\n        " + metadata;
    const Eigen::RowVectorXd zeros = Eigen::RowVectorXd::Zero(count);
    const auto put = [&](TextBuffer& out, std::ptrdiff_t i) {
      const Eigen::RowVectorXd row =
          i < rows ? Eigen::RowVectorXd(attribute.values.row(i).segment(first, count)) : zeros;
      if (!flat) return UsdaWriter::put_tuple(out, row);
      for (Eigen::Index k = 0; k < count; ++k) out.put(std::string_view(k == 0 ? "" : ", ")).put(double{row[k]});
    };
    out_.array(declaration, rows + (gaps ? 1 : 0), put, metadata);
    if (!attribute.per_corner()) return;
    const std::string name = declaration.substr(declaration.find(' ') + 1);
    out_.array(
        "int[] " + name + ":indices", static_cast<std::ptrdiff_t>(corners.size()),
        [&](TextBuffer& out, std::ptrdiff_t i) { out.put(corners[i] < 0 ? static_cast<Index>(rows) : corners[i]); });
  }

  /// Writes the faces of each material. The program that reads the file binds the materials.
  void write_materials() {
    std::set<std::string> taken;
    for (const FaceSet& set : faces_by_material(mesh_)) {
      if (set.name.empty()) continue;
      std::vector<Index> faces;
      for (const auto& range : set.ranges) {
        for (Index face = range.first; face < range.second; ++face) faces.push_back(face);
      }
      out_.line("");
      out_.open("def GeomSubset \"" + usda_identifier(set.name, taken) + "\"");
      out_.line("uniform token elementType = \"face\"");
      out_.line("uniform token familyName = \"materialBind\"");
      indices("int[] indices", faces);
      out_.close();
    }
  }

  const Mesh& mesh_;
  const UpAxis up_;
  const std::string& name_;
  FloatFrame frame_;
  UsdaWriter out_;
};

}  // namespace

bool is_usda_polygonal(const Mesh& mesh) {
  if (mesh.scheme && is_interpolating(*mesh.scheme)) return true;
  const bool has_word = mesh.scheme || mesh.boundary || mesh.crease_method || mesh.triangle_rule || mesh.face_varying ||
                        !mesh.creases.empty() || !mesh.corners.empty() || !mesh.holes.empty();
  return !has_word && corner_list(mesh, "normal").attribute != nullptr;
}

void write_usda(OutputFile& file, const Mesh& mesh, UpAxis up) { UsdaMesh(file, mesh, up).write(); }

}  // namespace batten::io
