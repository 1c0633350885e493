/// Surfaces for programs of medicine: VTK's legacy polydata, FreeSurfer's surfaces and GIFTI.
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/io/bytes.h"
#include "batten/io/formats.h"
#include "batten/io/text_output.h"
#include "batten/mesh/triangulate.h"

namespace batten::io {

namespace {

/// Appends a number with its most significant byte first.
template <typename T>
void put_big(ByteBuffer& out, T value) {
  UnsignedOf<sizeof(T)> bits;
  std::memcpy(&bits, &value, sizeof(T));
  out.put(reversed_bytes(bits));
}

/// The mesh as triangles whose coordinates are floats.
Mesh float_triangles(const OutputFile& file, const Mesh& mesh, const char* format) {
  if (mesh.face_count() == 0 && mesh.vertex_count() > 0)
    throw Error(ErrorCode::BadShape, file.name() + ": " + format +
                                         " holds a surface of triangles, and the mesh has no face; write xyz or ply");
  if (mesh.vertex_count() > 0 && mesh.points.cwiseAbs().maxCoeff() > std::numeric_limits<float>::max())
    throw Error(ErrorCode::BadArgument,
                file.name() + ": a coordinate is too large for the floats of " + format + "; scale it");
  return triangulated(mesh);
}

/// Bytes as text, three as four letters, with "=" for those that the last three lack.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kLetters[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// One block of numbers, three a row.
template <typename NumberOf>
void write_data_array(OutputFile& file, const std::string& head, std::ptrdiff_t rows, Encoding encoding,
                      const std::string& inner, const NumberOf& number_of) {
  file.write("<DataArray " + head + " ArrayIndexingOrder=\"RowMajorOrder\" Dimensionality=\"2\" Dim0=\"" +
             std::to_string(rows) + "\" Dim1=\"3\" Encoding=\"" +
             (encoding == Encoding::Binary ? "Base64Binary" : "ASCII") +
             "\" Endian=\"LittleEndian\" ExternalFileName=\"\" ExternalFileOffset=\"\">\n" + inner + "<Data>");
  if (encoding == Encoding::Binary) {
    ByteBuffer bytes;
    for (std::ptrdiff_t i = 0; i < 3 * rows; ++i) bytes.put(number_of(i));
    file.write(base64(bytes.text()));
  } else {
    write_rows<TextBuffer>(file, rows, [&](TextBuffer& out, std::ptrdiff_t row) {
      for (int k = 0; k < 3; ++k) {
        if constexpr (std::is_same_v<decltype(number_of(0)), float>) {
          out.put(static_cast<double>(number_of(3 * row + k))).put(' ');
        } else {
          out.put(number_of(3 * row + k)).put(' ');
        }
      }
      out.put('\n');
    });
  }
  file.write("</Data>\n</DataArray>\n");
}

}  // namespace

void write_vtk(OutputFile& file, const Mesh& mesh, Encoding encoding, const std::string& comment) {
  const bool text = encoding == Encoding::Text;
  file.expect_rows(mesh.vertex_count() + mesh.face_count());
  // The second line is a title of 256 letters at most.
  const std::string title = ("written by Batten" + (comment.empty() ? "" : ", " + comment)).substr(0, 255);
  file.write("# vtk DataFile Version 3.0\n" + title + "\n" + (text ? "ASCII" : "BINARY") +
             "\nDATASET POLYDATA\nPOINTS " + std::to_string(mesh.vertex_count()) + " double\n");
  if (text) {
    write_rows<TextBuffer>(file, mesh.vertex_count(), [&](TextBuffer& out, std::ptrdiff_t row) {
      out.put(mesh.points(row, 0)).put(' ').put(mesh.points(row, 1)).put(' ').put(mesh.points(row, 2)).put('\n');
    });
  } else {
    write_rows<ByteBuffer>(file, mesh.vertex_count(), [&](ByteBuffer& out, std::ptrdiff_t row) {
      for (int k = 0; k < 3; ++k) put_big(out, mesh.points(row, k));
    });
    file.write("\n");
  }
  const std::size_t numbers = mesh.face_vertices.size() + static_cast<std::size_t>(mesh.face_count());
  file.write("POLYGONS " + std::to_string(mesh.face_count()) + " " + std::to_string(numbers) + "\n");
  if (text) return write_face_rows(file, mesh);
  write_rows<ByteBuffer>(file, mesh.face_count(), [&](ByteBuffer& out, std::ptrdiff_t row) {
    const auto face = static_cast<Index>(row);
    put_big(out, mesh.face_size(face));
    for (Index i = mesh.face_offsets[face]; i < mesh.face_offsets[face + 1]; ++i) put_big(out, mesh.face_vertices[i]);
  });
  file.write("\n");
}

void write_freesurfer(OutputFile& file, const Mesh& mesh, Encoding encoding, const std::string& comment) {
  const Mesh triangles = float_triangles(file, mesh, "FreeSurfer's format");
  const std::string about = "created by Batten" + (comment.empty() ? "" : " " + comment);
  file.expect_rows(triangles.vertex_count() + triangles.face_count());
  if (encoding == Encoding::Text) {
    file.write("#!ascii " + about + "\n" + std::to_string(triangles.vertex_count()) + " " +
               std::to_string(triangles.face_count()) + "\n");
    write_rows<TextBuffer>(file, triangles.vertex_count(), [&](TextBuffer& out, std::ptrdiff_t row) {
      for (int k = 0; k < 3; ++k) out.put(triangles.points(row, k)).put(' ');
      out.put("0\n");
    });
    write_rows<TextBuffer>(file, triangles.face_count(), [&](TextBuffer& out, std::ptrdiff_t row) {
      for (int k = 0; k < 3; ++k) out.put(triangles.face_vertices[3 * row + k]).put(' ');
      out.put("0\n");
    });
    return;
  }
  ByteBuffer head;
  for (const int byte : {0xff, 0xff, 0xfe}) head.put(static_cast<std::uint8_t>(byte));
  file.write(head.text());
  file.write(about + "\n\n");
  ByteBuffer counts;
  put_big(counts, triangles.vertex_count());
  put_big(counts, triangles.face_count());
  file.write(counts.text());
  write_rows<ByteBuffer>(file, triangles.vertex_count(), [&](ByteBuffer& out, std::ptrdiff_t row) {
    for (int k = 0; k < 3; ++k) put_big(out, static_cast<float>(triangles.points(row, k)));
  });
  write_rows<ByteBuffer>(file, triangles.face_count(), [&](ByteBuffer& out, std::ptrdiff_t row) {
    for (int k = 0; k < 3; ++k) put_big(out, triangles.face_vertices[3 * row + k]);
  });
}

void write_gifti(OutputFile& file, const Mesh& mesh, Encoding encoding) {
  const Mesh triangles = float_triangles(file, mesh, "GIFTI");
  file.expect_rows(encoding == Encoding::Text ? triangles.vertex_count() + triangles.face_count() : 0);
  file.write(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!DOCTYPE GIFTI SYSTEM \"http://www.nitrc.org/frs/download.php/115/gifti.dtd\">\n"
      "<GIFTI Version=\"1.0\" NumberOfDataArrays=\"2\">\n<MetaData/>\n<LabelTable/>\n");
  const std::string space =
      "<MetaData/>\n<CoordinateSystemTransformMatrix>\n<DataSpace><![CDATA[NIFTI_XFORM_SCANNER_ANAT]]></DataSpace>\n"
      "<TransformedSpace><![CDATA[NIFTI_XFORM_SCANNER_ANAT]]></TransformedSpace>\n"
      "<MatrixData>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</MatrixData>\n</CoordinateSystemTransformMatrix>\n";
  write_data_array(file, "Intent=\"NIFTI_INTENT_POINTSET\" DataType=\"NIFTI_TYPE_FLOAT32\"", triangles.vertex_count(),
                   encoding, space, [&](std::ptrdiff_t i) { return static_cast<float>(triangles.points.data()[i]); });
  write_data_array(file, "Intent=\"NIFTI_INTENT_TRIANGLE\" DataType=\"NIFTI_TYPE_INT32\"", triangles.face_count(),
                   encoding, "<MetaData/>\n", [&](std::ptrdiff_t i) { return triangles.face_vertices[i]; });
  file.write("</GIFTI>\n");
}

}  // namespace batten::io
