/// \file The geometry for the rays: the surface as triangles with shading normals, in floats around the origin.
#pragma once
#include <Eigen/Geometry>

#include "batten/render/render.h"

namespace batten::render_detail {

using Vec = Eigen::Vector3f;

/// Points are moved by (p - centre) * scale into the unit sphere before they become floats.
struct Frame {
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
  double scale = 1.0;
  Eigen::RowVector3d lowest = Eigen::RowVector3d::Zero();  ///< of the bounding box, in the mesh's unit
  Eigen::RowVector3d highest = Eigen::RowVector3d::Zero();

  Vec apply(const Eigen::RowVector3d& point) const { return ((point - centre) * scale).transpose().cast<float>(); }
};

struct Triangles {
  Buffer<Vec> points;                 ///< V, and one more because Embree may read past the end
  Buffer<std::uint32_t> vertices;     ///< 3T
  Buffer<std::uint32_t> normal_rows;  ///< 3T rows of `normals`; empty if equal to `vertices`
  Buffer<Vec> normals;   ///< unit length or zero; V, then one for each corner of the mesh where normals are split
  Buffer<Vec> colors;    ///< V or empty
  Buffer<float> levels;  ///< V positions on the colour scale, or empty

  std::size_t count() const { return vertices.size() / 3; }
  std::uint32_t normal_row(std::size_t corner) const {
    return normal_rows.empty() ? vertices[corner] : normal_rows[corner];
  }
};

/// Throws Error(BadShape, IndexOutOfRange, NotFinite, BadArgument) for a scene that cannot be drawn.
void check_scene(const Scene& scene);

/// The frame of the surfaces' faces, the markers and the lines of all scenes.
Frame frame_of(const std::vector<const Scene*>& scenes);

Triangles triangles_of(const Scene& scene, const Frame& frame);

/// Fills the normals, and normal_rows for the fan triangles, whose corners in the mesh are given. A normal is the mean
/// of the vertex's faces weighted by their angle there, separately for each run of faces that meet at less than 40
/// degrees.
void compute_normals(const Mesh& mesh, const Buffer<std::uint32_t>& triangle_corners, Triangles& triangles);

}  // namespace batten::render_detail
