#include "batten/render/geometry.h"

#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten::render_detail {
namespace {

void check_mesh(const Mesh& mesh, const char* what) {
  const auto& offsets = mesh.face_offsets;
  bool sound =
      !offsets.empty() && offsets.front() == 0 && static_cast<std::size_t>(offsets.back()) == mesh.face_vertices.size();
  for (std::size_t f = 0; sound && f + 1 < offsets.size(); ++f) sound = offsets[f] <= offsets[f + 1];
  if (!sound)
    throw Error(ErrorCode::BadShape, std::string("the face offsets of the ") + what +
                                         " must start at 0, not decrease and end at the number of corners");
  for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
    const Index vertex = mesh.face_vertices[c];
    if (vertex < 0 || vertex >= mesh.vertex_count())
      throw Error(ErrorCode::IndexOutOfRange, std::string("corner ") + std::to_string(c) + " of the " + what +
                                                  " names vertex " + std::to_string(vertex) + " of " +
                                                  std::to_string(mesh.vertex_count()));
  }
}

void check_finite(ConstValuesRef values, const char* what) {
  const bool finite = parallel_all_of(values.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    return values.middleRows(begin, end - begin).allFinite();
  });
  if (finite) return;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    if (values.row(i).allFinite()) continue;
    throw Error(ErrorCode::NotFinite, std::string("row ") + std::to_string(i) + " of the " + what +
                                          " is not finite; a picture needs finite numbers");
  }
}

void check_rows(const Values& values, Eigen::Index rows, const char* what) {
  if (values.size() == 0) return;
  if (values.rows() != rows || values.cols() != 3)
    throw Error(ErrorCode::BadShape, std::string("the ") + what +
                                         " must be empty or one row of 3 a vertex of the surface (" +
                                         std::to_string(rows) + "), not " + std::to_string(values.rows()) + " by " +
                                         std::to_string(values.cols()));
  check_finite(values, what);
}

struct Box {
  Eigen::Array3d lowest = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d highest = Eigen::Array3d::Constant(-std::numeric_limits<double>::infinity());

  void include(const Eigen::RowVector3d& point) {
    lowest = lowest.min(point.transpose().array());
    highest = highest.max(point.transpose().array());
  }
  static Box join(Box a, const Box& b) {
    a.lowest = a.lowest.min(b.lowest);
    a.highest = a.highest.max(b.highest);
    return a;
  }
};

/// Only vertices of faces count, because files contain stray vertices.
Box box_of_faces(const Mesh& mesh) {
  return parallel_reduce<Box>(
      static_cast<std::ptrdiff_t>(mesh.face_vertices.size()), Box(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Box box;
        for (std::ptrdiff_t c = begin; c < end; ++c)
          box.include(mesh.points.row(mesh.face_vertices[static_cast<std::size_t>(c)]));
        return box;
      },
      Box::join);
}

std::vector<bool> drawn_faces(const Mesh& mesh) {
  std::vector<bool> drawn(static_cast<std::size_t>(mesh.face_count()), true);
  for (const Index hole : mesh.holes) {
    if (hole >= 0 && hole < mesh.face_count()) drawn[static_cast<std::size_t>(hole)] = false;
  }
  return drawn;
}

/// Where a face's fan starts: at the first corner, or at the second of a quad that folds over the diagonal from the
/// first.
Index fan_start(const Mesh& mesh, const Buffer<Vec>& points, Index face) {
  if (mesh.face_size(face) != 4) return 0;
  const Index* v = mesh.face_vertices.data() + mesh.face_offsets[face];
  const auto normal = [&](int a, int b, int c) {
    return Vec((points[v[b]] - points[v[a]]).cross(points[v[c]] - points[v[a]]));
  };
  return normal(0, 1, 2).dot(normal(0, 2, 3)) < 0.0F && normal(1, 2, 3).dot(normal(1, 3, 0)) > 0.0F ? 1 : 0;
}

/// The corners of the mesh for each triangle of the fans.
Buffer<std::uint32_t> fan_corners(const Mesh& mesh, const Buffer<Vec>& points) {
  const std::vector<bool> drawn = drawn_faces(mesh);
  Buffer<Index> first(static_cast<std::size_t>(mesh.face_count()) + 1);
  first[0] = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const bool shown = drawn[static_cast<std::size_t>(f)] && mesh.face_size(f) >= 3;
    first[f + 1] = first[f] + (shown ? mesh.face_size(f) - 2 : 0);
  }
  Buffer<std::uint32_t> corners(3 * static_cast<std::size_t>(first[mesh.face_count()]));
  parallel_for(mesh.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const Index triangles = first[f + 1] - first[f];
      const Index size = triangles + 2;
      const Index start = triangles > 0 ? fan_start(mesh, points, f) : 0;
      for (Index t = 0; t < triangles; ++t) {
        std::uint32_t* out = corners.data() + 3 * static_cast<std::size_t>(first[f] + t);
        const Index base = mesh.face_offsets[f];
        out[0] = static_cast<std::uint32_t>(base + start);
        out[1] = static_cast<std::uint32_t>(base + (start + t + 1) % size);
        out[2] = static_cast<std::uint32_t>(base + (start + t + 2) % size);
      }
    }
  });
  return corners;
}

}  // namespace

void check_scene(const Scene& scene) {
  check_mesh(scene.surface, "surface");
  check_mesh(scene.lines, "lines");
  if (scene.surface.face_count() == 0 && scene.markers.rows() == 0 && scene.lines.face_count() == 0)
    throw Error(ErrorCode::BadArgument, "nothing to draw: the surface has no faces, and there are no markers or lines");
  check_finite(scene.surface.points, "surface's points");
  check_finite(scene.lines.points, "lines' points");
  check_finite(scene.markers, "markers");
  const auto corners = static_cast<Eigen::Index>(scene.surface.face_vertices.size());
  check_rows(scene.normals, scene.normals.rows() == corners ? corners : scene.surface.vertex_count(), "normals");
  check_rows(scene.colors, scene.surface.vertex_count(), "colors");
  if (scene.scalars.size() > 0 && scene.scalars.size() != scene.surface.vertex_count())
    throw Error(ErrorCode::BadShape, "the scalars must be empty or one number a vertex of the surface (" +
                                         std::to_string(scene.surface.vertex_count()) + "), not " +
                                         std::to_string(scene.scalars.size()));
  if (scene.line_scalars.size() > 0 && scene.line_scalars.size() != scene.lines.face_count())
    throw Error(ErrorCode::BadShape, "the lines' scalars must be empty or one number a face of the lines (" +
                                         std::to_string(scene.lines.face_count()) + "), not " +
                                         std::to_string(scene.line_scalars.size()));
  if (scene.marker_scalars.size() > 0 && scene.marker_scalars.size() != scene.markers.rows())
    throw Error(ErrorCode::BadShape, "the markers' scalars must be empty or one number a marker (" +
                                         std::to_string(scene.markers.rows()) + "), not " +
                                         std::to_string(scene.marker_scalars.size()));
}

Frame frame_of(const std::vector<const Scene*>& scenes) {
  Box box;
  for (const Scene* scene : scenes) {
    box = Box::join(box, Box::join(box_of_faces(scene->surface), box_of_faces(scene->lines)));
    for (Eigen::Index i = 0; i < scene->markers.rows(); ++i) box.include(scene->markers.row(i));
  }
  Frame frame;
  frame.lowest = box.lowest.matrix().transpose();
  frame.highest = box.highest.matrix().transpose();
  // Halving first avoids overflow of the sum of two large doubles.
  frame.centre = 0.5 * frame.lowest + 0.5 * frame.highest;
  const double radius = (0.5 * frame.highest - 0.5 * frame.lowest).stableNorm();
  frame.scale = radius > 0.0 ? 1.0 / radius : 1.0;
  if (!std::isfinite(radius) || !std::isfinite(frame.scale))
    throw Error(ErrorCode::BadArgument, "the shape's extent is too large or too small for a picture; scale it");
  return frame;
}

Triangles triangles_of(const Scene& scene, const Frame& frame) {
  const Mesh& mesh = scene.surface;
  Triangles triangles;
  triangles.points.resize(static_cast<std::size_t>(mesh.vertex_count()) + 1);
  triangles.points.back() = Vec::Zero();
  parallel_for(mesh.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) triangles.points[v] = frame.apply(mesh.points.row(v));
  });
  const Buffer<std::uint32_t> corners = fan_corners(mesh, triangles.points);
  triangles.vertices.resize(corners.size());
  parallel_for(static_cast<std::ptrdiff_t>(corners.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t c = begin; c < end; ++c)
      triangles.vertices[c] = static_cast<std::uint32_t>(mesh.face_vertices[corners[c]]);
  });
  if (scene.normals.size() > 0) {
    if (scene.normals.rows() != mesh.vertex_count()) triangles.normal_rows = corners;
    triangles.normals.resize(static_cast<std::size_t>(scene.normals.rows()));
    for (Eigen::Index i = 0; i < scene.normals.rows(); ++i)
      triangles.normals[static_cast<std::size_t>(i)] =
          scene.normals.row(i).transpose().stableNormalized().cast<float>();
  } else {
    compute_normals(mesh, corners, triangles);
  }
  if (scene.colors.size() > 0) {
    triangles.colors.resize(static_cast<std::size_t>(mesh.vertex_count()));
    for (Index v = 0; v < mesh.vertex_count(); ++v) triangles.colors[v] = scene.colors.row(v).transpose().cast<float>();
  }
  for (const double value : scene.scalars) triangles.levels.push_back(static_cast<float>(scene.scale.position(value)));
  return triangles;
}

}  // namespace batten::render_detail
