/// \file Functions that the tests of readers and writers share.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/io/formats.h"
#include "batten/io/io.h"
#include "support/errors.h"

namespace batten::io_tests {

using test::error_of;
using test::expect_error;

/// A new folder that is removed with its content at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "batten-io-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path(const std::string& name) const { return (path_ / name).string(); }
  std::ptrdiff_t file_count() const {
    return std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator());
  }

 private:
  std::filesystem::path path_;
};

inline std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void make_file(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

using Reader = Mesh (*)(const io::Source&);

inline Mesh parse(Reader reader, const std::string& text, std::size_t chunk_bytes = io::kChunkBytes) {
  return reader({"test", text, chunk_bytes});
}

/// What the reader says that it skipped.
inline std::vector<std::string> notes_of(Reader reader, const std::string& text,
                                         std::size_t chunk_bytes = io::kChunkBytes) {
  std::vector<std::string> notes;
  reader({"test", text, chunk_bytes, {}, &notes});
  return notes;
}

/// The text with the line ends of old Macintosh programs.
inline std::string with_carriage_returns(std::string text) {
  std::replace(text.begin(), text.end(), '\n', '\r');
  return text;
}

/// Expects an Error with this code and this part of its message, in whatever pieces the text is read.
inline void expect_read_error(Reader reader, const std::string& text, ErrorCode code, const std::string& part) {
  for (const std::size_t chunk_bytes : {std::size_t{1}, io::kChunkBytes}) {
    expect_error([&] { parse(reader, text, chunk_bytes); }, code, part);
  }
}

/// Equal to the bit, -0 and NaN included.
inline bool same_bits(ConstValuesRef a, ConstValuesRef b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index k = 0; k < a.cols(); ++k) {
      const double x = a(i, k);
      const double y = b(i, k);
      if (std::memcmp(&x, &y, sizeof(double)) != 0) return false;
    }
  }
  return true;
}

inline void expect_same_faces(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.face_offsets, b.face_offsets);
  EXPECT_EQ(a.face_vertices, b.face_vertices);
}

inline void expect_same_attributes(const Mesh& a, const Mesh& b) {
  ASSERT_EQ(a.attributes.size(), b.attributes.size());
  for (std::size_t i = 0; i < a.attributes.size(); ++i) {
    EXPECT_EQ(a.attributes[i].name, b.attributes[i].name);
    EXPECT_TRUE(same_bits(a.attributes[i].values, b.attributes[i].values)) << a.attributes[i].name;
    EXPECT_EQ(a.attributes[i].corner_rows, b.attributes[i].corner_rows) << a.attributes[i].name;
  }
}

inline void expect_same_tags(const Mesh& a, const Mesh& b) {
  ASSERT_EQ(a.creases.size(), b.creases.size());
  for (std::size_t i = 0; i < a.creases.size(); ++i) {
    EXPECT_EQ(a.creases[i].a, b.creases[i].a);
    EXPECT_EQ(a.creases[i].b, b.creases[i].b);
    EXPECT_EQ(a.creases[i].sharpness, b.creases[i].sharpness);
  }
  ASSERT_EQ(a.corners.size(), b.corners.size());
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    EXPECT_EQ(a.corners[i].vertex, b.corners[i].vertex);
    EXPECT_EQ(a.corners[i].sharpness, b.corners[i].sharpness);
  }
  EXPECT_EQ(a.holes, b.holes);
  EXPECT_EQ(a.boundary, b.boundary);
  EXPECT_EQ(a.crease_method, b.crease_method);
  EXPECT_EQ(a.triangle_rule, b.triangle_rule);
  EXPECT_EQ(a.face_varying, b.face_varying);
}

inline void expect_same_mesh(const Mesh& a, const Mesh& b) {
  EXPECT_TRUE(same_bits(a.points, b.points));
  expect_same_faces(a, b);
  expect_same_attributes(a, b);
  expect_same_tags(a, b);
  ASSERT_EQ(a.groups.size(), b.groups.size());
  for (std::size_t i = 0; i < a.groups.size(); ++i) {
    EXPECT_EQ(a.groups[i].keyword, b.groups[i].keyword);
    EXPECT_EQ(a.groups[i].name, b.groups[i].name);
    EXPECT_EQ(a.groups[i].first_face, b.groups[i].first_face);
  }
  EXPECT_EQ(a.material_libraries, b.material_libraries);
}

/// Finite doubles of all sizes, every bit pattern as likely, with the extremes in front.
inline Values random_doubles(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  const double extremes[] = {0.0,
                             -0.0,
                             5e-324,
                             -5e-324,
                             2.2250738585072014e-308,
                             2.225073858507201e-308,
                             1.7976931348623157e308,
                             -1.7976931348623157e308,
                             0.1,
                             1.0 / 3.0,
                             9007199254740993.0,
                             1e22};
  std::mt19937_64 generator(seed);
  Values values(rows, columns);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    double value = std::nan("");
    while (!std::isfinite(value)) {
      const std::uint64_t bits = generator();
      std::memcpy(&value, &bits, sizeof(value));
    }
    values.data()[i] = i < 12 ? extremes[i] : value;
  }
  return values;
}

/// Random points, and faces of 3 to 7 corners.
inline Mesh random_mesh(Index vertex_count, Index face_count, unsigned seed = 1) {
  Mesh mesh;
  mesh.points = random_doubles(vertex_count, 3, seed);
  std::mt19937 generator(seed);
  for (Index face = 0; face < face_count; ++face) {
    const unsigned size = 3 + generator() % 5;
    for (unsigned k = 0; k < size; ++k) mesh.face_vertices.push_back(static_cast<Index>(generator() % vertex_count));
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  return mesh;
}

/// Writes the mesh into a new folder and reads it back.
inline Mesh round_trip(const Mesh& mesh, const std::string& format, bool binary = true) {
  const TemporaryFolder folder;
  const std::string path = folder.path("mesh." + format);
  write_mesh(path, mesh, {"", binary});
  return read_mesh(path);
}

}  // namespace batten::io_tests
