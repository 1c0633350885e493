#include "batten/io/merged_corners.h"

#include <algorithm>

namespace batten::io {

namespace {

/// -1, 0 or 1: the order of two corners by the values of the lists. A corner without a row comes first.
int compare(const Mesh& mesh, const std::vector<CornerList>& lists, Index a, Index b) {
  for (const CornerList& list : lists) {
    const Index row_a = list.row(mesh, a);
    const Index row_b = list.row(mesh, b);
    if (row_a == row_b) continue;
    if (row_a < 0 || row_b < 0) return row_a < row_b ? -1 : 1;
    for (Eigen::Index k = 0; k < list.attribute->values.cols(); ++k) {
      const double value_a = list.attribute->values(row_a, k);
      const double value_b = list.attribute->values(row_b, k);
      if (value_a != value_b) return value_a < value_b ? -1 : 1;
    }
  }
  return 0;
}

/// The visible corners of each vertex v: corners[starts[v]] to corners[starts[v + 1]], ascending.
struct VertexCorners {
  Buffer<Index> starts;
  Buffer<Index> corners;
};

VertexCorners visible_corners(const Mesh& mesh, const Buffer<std::uint8_t>& hidden) {
  VertexCorners result;
  result.starts.assign(static_cast<std::size_t>(mesh.vertex_count()) + 1, 0);
  const auto for_each = [&](const auto& visit) {
    for (Index face = 0; face < mesh.face_count(); ++face) {
      if (hidden[face] != 0) continue;
      for (Index corner = mesh.face_offsets[face]; corner < mesh.face_offsets[face + 1]; ++corner) visit(corner);
    }
  };
  for_each([&](Index corner) { ++result.starts[mesh.face_vertices[corner]]; });
  Index sum = 0;
  for (Index& start : result.starts) {
    sum += start;
    start = sum;
  }
  // Each start is its vertex's end at this point; filling backwards turns it into the beginning.
  result.corners.resize(static_cast<std::size_t>(sum));
  for_each([&](Index corner) { result.corners[--result.starts[mesh.face_vertices[corner]]] = corner; });
  for (Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    std::reverse(result.corners.begin() + result.starts[vertex], result.corners.begin() + result.starts[vertex + 1]);
  }
  return result;
}

}  // namespace

MergedCorners merge_corners(const Mesh& mesh, const std::vector<CornerList>& lists,
                            const Buffer<std::uint8_t>& hidden) {
  VertexCorners at = visible_corners(mesh, hidden);
  MergedCorners merged;
  merged.vertex_of_corner.assign(mesh.face_vertices.size(), -1);
  for (Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    const auto begin = at.corners.begin() + at.starts[vertex];
    const auto end = at.corners.begin() + at.starts[vertex + 1];
    std::sort(begin, end, [&](Index a, Index b) {
      const int order = compare(mesh, lists, a, b);
      return order != 0 ? order < 0 : a < b;
    });
    for (auto corner = begin; corner != end; ++corner) {
      if (corner == begin || compare(mesh, lists, *(corner - 1), *corner) != 0) {
        merged.corner_of_vertex.push_back(*corner);
      }
      merged.vertex_of_corner[*corner] = static_cast<Index>(merged.corner_of_vertex.size()) - 1;
    }
  }
  return merged;
}

}  // namespace batten::io
