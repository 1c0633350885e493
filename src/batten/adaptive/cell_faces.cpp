#include "batten/adaptive/cell_faces.h"

#include <algorithm>
#include <limits>

#include "batten/parallel/parallel.h"
#include "batten/patch/corner_parameters.h"

namespace batten {

namespace {

using Spot = std::array<double, 2>;

/// A leaf with the vertices in the middles of its sides: at most eight corners.
struct Polygon {
  struct Corner {
    Index vertex;
    Spot at;  ///< in the cell
    bool hanging;
    int side;  ///< the side that starts here or is halved here
  };
  std::array<Corner, 8> corners;
  int count = 0;
  void add(const Corner& corner) { corners[count++] = corner; }
  int after(int i) const { return i + 1 == count ? 0 : i + 1; }
  int before(int i) const { return i == 0 ? count - 1 : i - 1; }
};

Spot middle_of(const Spot& a, const Spot& b) { return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])}; }

Polygon polygon_of(const CellForest& forest, Index cell) {
  Polygon polygon;
  const int n = forest.corner_count();
  for (int s = 0; s < n; ++s) {
    const Spot at = corner_parameters(n, s);
    polygon.add({forest.corner(cell, s), at, false, s});
    const Index hanging = forest.hanging_vertex(cell, s);
    if (hanging >= 0) polygon.add({hanging, middle_of(at, corner_parameters(n, s + 1 == n ? 0 : s + 1)), true, s});
  }
  return polygon;
}

/// The number of each leaf's first face, and the total at the end.
template <typename Count>
Buffer<std::size_t> face_starts(const Buffer<Index>& leaves, const Count& count) {
  Buffer<std::size_t> starts(leaves.size() + 1);
  parallel_for(static_cast<std::ptrdiff_t>(leaves.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) starts[i + 1] = static_cast<std::size_t>(count(leaves[i]));
  });
  starts[0] = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) starts[i + 1] += starts[i];
  return starts;
}

/// Writes the faces of one leaf, corner by corner.
class FaceWriter {
 public:
  FaceWriter(const CellForest& forest, Index cell, std::size_t first, CellFaces& faces)
      : forest_(forest), cell_(cell), next_(first * static_cast<std::size_t>(faces.size)), faces_(faces) {}
  void corner(Index vertex, const Spot& at) {
    const SurfacePlace place = forest_.place(cell_, at[0], at[1]);
    faces_.vertices[next_] = vertex;
    faces_.places[next_] = {place.u, place.v};
    faces_.cells[next_ / static_cast<std::size_t>(faces_.size)] = cell_;
    ++next_;
  }
  void triangle(const Polygon::Corner& a, const Polygon::Corner& b, const Polygon::Corner& c) {
    corner(a.vertex, a.at);
    corner(b.vertex, b.at);
    corner(c.vertex, c.at);
  }

 private:
  const CellForest& forest_;
  Index cell_;
  std::size_t next_;
  CellFaces& faces_;
};

void resize(CellFaces& faces, Index size, std::size_t count) {
  faces.size = size;
  faces.vertices.resize(count * static_cast<std::size_t>(size));
  faces.places.resize(count * static_cast<std::size_t>(size));
  faces.cells.resize(count);
}

Polygon cut_corners(const Polygon& polygon, FaceWriter& writer) {
  Polygon rest;
  for (int i = 0; i < polygon.count; ++i) {
    const Polygon::Corner& before = polygon.corners[polygon.before(i)];
    const Polygon::Corner& here = polygon.corners[i];
    const Polygon::Corner& after = polygon.corners[polygon.after(i)];
    if (!here.hanging && before.hanging && after.hanging) {
      writer.triangle(before, here, after);
    } else {
      rest.add(here);
    }
  }
  return rest;
}

/// Marks vertices of only two faces. Their cells share two sides, so a diagonal across would be the same edge for both.
Buffer<std::uint8_t> pinched_vertices(const CellForest& forest) {
  const Topology& base = forest.base();
  Buffer<std::uint8_t> pinched(static_cast<std::size_t>(forest.vertex_count()), 0);
  for (Index f = 0; f < base.face_count(); ++f) {
    for (int k = 0; k < forest.corner_count() && !forest.is_left_out(f); ++k) {
      const Index v = base.origin(base.face_begin(f) + k);
      if (!base.is_boundary_vertex(v) && base.vertex_face_count(v) == 2) pinched[forest.corner(f, k)] = 1;
    }
  }
  return pinched;
}

/// The vertex at which the fan starts. If it is the middle of a side, no triangle of the fan is flat.
int fan_start(const Polygon& polygon, const Points& points, const Buffer<std::uint8_t>& pinched) {
  if (polygon.count == 3) return 0;
  const bool any = std::any_of(polygon.corners.begin(), polygon.corners.begin() + polygon.count,
                               [](const Polygon::Corner& corner) { return corner.hanging; });
  for (int i = 0; i < polygon.count && !any; ++i) {
    if (pinched[polygon.corners[i].vertex] != 0) return i;
  }
  int best = 0;
  double shortest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < polygon.count; ++i) {
    if (any && !polygon.corners[i].hanging) continue;
    double longest = 0.0;
    for (int step = 2; step + 1 < polygon.count; ++step) {
      const Index other = polygon.corners[(i + step) % polygon.count].vertex;
      longest = std::max(longest, (points.row(polygon.corners[i].vertex) - points.row(other)).squaredNorm());
    }
    if (longest < shortest) {
      best = i;
      shortest = longest;
    }
  }
  return best;
}

/// Numbers the vertices that halve the polygons' sides: one for each side of a leaf whose neighbour is not finer.
Buffer<Index> number_side_middles(const CellForest& forest, const Buffer<Index>& leaves, CellFaces& faces) {
  const int n = forest.corner_count();
  Buffer<Index> middles(static_cast<std::size_t>(forest.cell_count()) * 4, -1);
  for (const Index cell : leaves) {
    for (int s = 0; s < n; ++s) {
      Index& middle = middles[4 * static_cast<std::size_t>(cell) + static_cast<std::size_t>(s)];
      const CellForest::Side across = forest.neighbour(cell, s);
      if (across.cell >= 0 && !forest.is_leaf(across.cell)) continue;
      if (across.cell >= 0 && across.cell < cell && forest.level(across.cell) == forest.level(cell)) {
        middle = middles[4 * static_cast<std::size_t>(across.cell) + static_cast<std::size_t>(across.side)];
        continue;
      }
      middle = forest.vertex_count() + static_cast<Index>(faces.added.size());
      const Spot at = middle_of(corner_parameters(n, s), corner_parameters(n, s + 1 == n ? 0 : s + 1));
      faces.added.push_back(forest.place(cell, at[0], at[1]));
    }
  }
  return middles;
}

/// The vertex in the middle of the polygon's side that starts at corner i.
Index middle_after(const CellForest& forest, Index cell, const Polygon& polygon, int i, const Buffer<Index>& middles) {
  const Polygon::Corner& here = polygon.corners[i];
  const bool halved = here.hanging || polygon.corners[polygon.after(i)].hanging;
  const auto middle = [&](Index c, int side) {
    return middles[4 * static_cast<std::size_t>(c) + static_cast<std::size_t>(side)];
  };
  if (!halved) return middle(cell, here.side);
  // The finer cells across are in the opposite order.
  const CellForest::Side across = forest.neighbour(cell, here.side);
  const int following = across.side + 1 == forest.corner_count() ? 0 : across.side + 1;
  return middle(forest.child(across.cell, here.hanging ? across.side : following), across.side);
}

}  // namespace

Index most_faces(Index asked, Index size) { return std::min(asked, std::numeric_limits<Index>::max() / size); }

CellFaces triangles_of(const CellForest& forest, const Points& points) {
  const Buffer<Index> leaves = forest.leaves();
  const Buffer<std::size_t> starts =
      face_starts(leaves, [&](Index cell) { return polygon_of(forest, cell).count - 2; });
  const Buffer<std::uint8_t> pinched = pinched_vertices(forest);
  CellFaces faces;
  resize(faces, 3, starts.back());
  parallel_for(static_cast<std::ptrdiff_t>(leaves.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      FaceWriter writer(forest, leaves[i], starts[i], faces);
      const Polygon rest = cut_corners(polygon_of(forest, leaves[i]), writer);
      const int start = fan_start(rest, points, pinched);
      for (int step = 1; step + 1 < rest.count; ++step) {
        writer.triangle(rest.corners[start], rest.corners[(start + step) % rest.count],
                        rest.corners[(start + step + 1) % rest.count]);
      }
    }
  });
  return faces;
}

CellFaces quads_of(const CellForest& forest) {
  const Buffer<Index> leaves = forest.leaves();
  const Buffer<std::size_t> starts = face_starts(leaves, [&](Index cell) { return polygon_of(forest, cell).count; });
  CellFaces faces;
  resize(faces, 4, starts.back());
  const Buffer<Index> middles = number_side_middles(forest, leaves, faces);
  const Index first_centre = forest.vertex_count() + static_cast<Index>(faces.added.size());
  const Spot centre = forest.corner_count() == 4 ? Spot{0.5, 0.5} : Spot{1.0 / 3.0, 1.0 / 3.0};
  for (const Index cell : leaves) faces.added.push_back(forest.place(cell, centre[0], centre[1]));
  parallel_for(static_cast<std::ptrdiff_t>(leaves.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t l = begin; l < end; ++l) {
      FaceWriter writer(forest, leaves[l], starts[l], faces);
      const Polygon polygon = polygon_of(forest, leaves[l]);
      for (int i = 0; i < polygon.count; ++i) {
        const Polygon::Corner& before = polygon.corners[polygon.before(i)];
        const Polygon::Corner& here = polygon.corners[i];
        const Polygon::Corner& after = polygon.corners[polygon.after(i)];
        writer.corner(here.vertex, here.at);
        writer.corner(middle_after(forest, leaves[l], polygon, i, middles), middle_of(here.at, after.at));
        writer.corner(first_centre + static_cast<Index>(l), centre);
        writer.corner(middle_after(forest, leaves[l], polygon, polygon.before(i), middles),
                      middle_of(before.at, here.at));
      }
    }
  });
  return faces;
}

CellFaces leaves_of(const CellForest& forest) {
  const Buffer<Index> leaves = forest.leaves();
  CellFaces faces;
  resize(faces, static_cast<Index>(forest.corner_count()), leaves.size());
  for (std::size_t l = 0; l < leaves.size(); ++l) {
    FaceWriter writer(forest, leaves[l], l, faces);
    for (int k = 0; k < forest.corner_count(); ++k) {
      writer.corner(forest.corner(leaves[l], k), corner_parameters(forest.corner_count(), k));
    }
  }
  return faces;
}

}  // namespace batten
