#include "batten/fit/dual_contour.h"

#include <array>
#include <vector>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// The corners of a cell are numbered by bits x + 2 y + 4 z; edge 4 a + r runs along axis a from the corner with the
/// other two axes' bits r (the next axis first). A face is 2 a + s: its normal's axis and side.
struct CellTables {
  std::array<std::array<int, 2>, 12> edge_corners{};
  std::array<std::array<int, 4>, 6> face_corners{};  ///< in a circle
  std::array<std::array<int, 4>, 6> face_edges{};    ///< edge r from corner r to the next

  CellTables() {
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      const int c = (a + 2) % 3;
      for (int r = 0; r < 4; ++r) {
        const int low = (r & 1) << b | (r >> 1) << c;
        edge_corners[4 * a + r] = {low, low | 1 << a};
      }
      for (int s = 0; s < 2; ++s) {
        const int base = s << a;
        face_corners[2 * a + s] = {base, base | 1 << b, base | 1 << b | 1 << c, base | 1 << c};
      }
    }
    for (int face = 0; face < 6; ++face) {
      for (int r = 0; r < 4; ++r) face_edges[face][r] = edge_of(face_corners[face][r], face_corners[face][(r + 1) % 4]);
    }
  }
  int edge_of(int a, int b) const {
    for (int e = 0; e < 12; ++e) {
      if ((edge_corners[e][0] == a && edge_corners[e][1] == b) || (edge_corners[e][0] == b && edge_corners[e][1] == a))
        return e;
    }
    return -1;
  }
};

const CellTables& cell_tables() {
  static const CellTables tables;
  return tables;
}

/// A cell that the surface crosses, and the sheet of each of its edges.
struct CrossedCell {
  std::array<Index, 3> at;
  std::array<std::int8_t, 12> sheet;  ///< -1 where the edge is not crossed
  std::int8_t sheets;
  std::uint8_t turned;  ///< faces where the decider's choice is turned over, as bits
  Index first_vertex;
};

class Contour {
 public:
  explicit Contour(const ValueGrid& grid) : grid_(grid), tables_(cell_tables()) {}

  Mesh make() {
    find_cells();
    for (CrossedCell& cell : cells_) find_sheets(cell);
    while (turn_double_faces()) {
    }
    Mesh mesh;
    place_vertices(mesh);
    join_quads(mesh);
    return mesh;
  }

 private:
  bool is_border(Index i, Index j, Index k) const {
    return i == 0 || j == 0 || k == 0 || i == grid_.nodes[0] - 1 || j == grid_.nodes[1] - 1 || k == grid_.nodes[2] - 1;
  }
  /// The number at a node; outside on the border.
  double number(Index i, Index j, Index k) const {
    const double value = grid_.values[grid_.node(i, j, k)];
    if (!is_border(i, j, k)) return value;
    return value > 0.0 ? -value : value;
  }
  double corner_number(const std::array<Index, 3>& at, int corner) const {
    return number(at[0] + (corner & 1), at[1] + (corner >> 1 & 1), at[2] + (corner >> 2 & 1));
  }
  int inside_bits(Index i, Index j, Index k) const {
    int bits = 0;
    for (int corner = 0; corner < 8; ++corner) bits |= (corner_number({i, j, k}, corner) > 0.0 ? 1 : 0) << corner;
    return bits;
  }
  std::ptrdiff_t cell_place(const std::array<Index, 3>& at) const { return grid_.node(at[0], at[1], at[2]); }

  void find_cells() {
    cell_of_.assign(static_cast<std::size_t>(grid_.count()), -1);
    for (Index k = 0; k + 1 < grid_.nodes[2]; ++k) {
      for (Index j = 0; j + 1 < grid_.nodes[1]; ++j) {
        for (Index i = 0; i + 1 < grid_.nodes[0]; ++i) {
          const int bits = inside_bits(i, j, k);
          if (bits == 0 || bits == 255) continue;
          cell_of_[grid_.node(i, j, k)] = static_cast<Index>(cells_.size());
          cells_.push_back({{i, j, k}, {}, 0, 0, 0});
        }
      }
    }
  }

  /// On a face with inside corners across from each other: whether the inside is joined in the middle.
  bool joined_inside(const CrossedCell& cell, int face) const {
    std::array<double, 4> f{};
    for (int r = 0; r < 4; ++r) f[r] = corner_number(cell.at, tables_.face_corners[face][r]);
    const double inside = f[0] > 0.0 ? f[0] * f[2] : f[1] * f[3];
    const double outside = f[0] > 0.0 ? f[1] * f[3] : f[0] * f[2];
    return (inside > outside) != ((cell.turned >> face & 1) != 0);
  }

  /// Joins the crossed edges of each face in pairs: rings of edges are sheets.
  void find_sheets(CrossedCell& cell) const {
    std::array<std::array<std::int8_t, 2>, 12> next{};
    std::array<std::int8_t, 12> filled{};
    const auto join = [&](int a, int b) {
      next[a][filled[a]++] = static_cast<std::int8_t>(b);
      next[b][filled[b]++] = static_cast<std::int8_t>(a);
    };
    for (int face = 0; face < 6; ++face) {
      const std::array<int, 4>& edges = tables_.face_edges[face];
      std::array<int, 4> crossed{};
      int count = 0;
      for (int r = 0; r < 4; ++r) {
        const double a = corner_number(cell.at, tables_.face_corners[face][r]);
        const double b = corner_number(cell.at, tables_.face_corners[face][(r + 1) % 4]);
        if ((a > 0.0) != (b > 0.0)) crossed[count++] = edges[r];
      }
      if (count == 2) join(crossed[0], crossed[1]);
      if (count != 4) continue;
      // Edge r lies between corners r and r + 1: edges 3 and 0 cut off corner 0.
      const bool corner_inside = corner_number(cell.at, tables_.face_corners[face][0]) > 0.0;
      const bool cut_corner = corner_inside != joined_inside(cell, face);
      join(edges[cut_corner ? 3 : 0], edges[cut_corner ? 0 : 1]);
      join(edges[cut_corner ? 1 : 2], edges[cut_corner ? 2 : 3]);
    }
    cell.sheet.fill(-1);
    cell.sheets = 0;
    for (int e = 0; e < 12; ++e) {
      if (filled[e] == 0 || cell.sheet[e] >= 0) continue;
      int before = -1;
      for (int at = e; cell.sheet[at] < 0;) {
        cell.sheet[at] = cell.sheets;
        const int on = next[at][0] != before && cell.sheet[next[at][0]] < 0 ? next[at][0] : next[at][1];
        before = at;
        at = on;
      }
      ++cell.sheets;
    }
  }

  /// True where the two lines on a face belong to one sheet of the cell.
  bool is_double(const CrossedCell& cell, int face) const {
    const std::array<int, 4>& edges = tables_.face_edges[face];
    for (const int edge : edges) {
      if (cell.sheet[edge] < 0 || cell.sheet[edge] != cell.sheet[edges[0]]) return false;
    }
    return true;
  }

  bool turn_double_faces() {
    bool any = false;
    for (CrossedCell& cell : cells_) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!is_double(cell, 2 * axis + 1)) continue;
        std::array<Index, 3> at = cell.at;
        ++at[axis];
        if (at[axis] + 1 >= grid_.nodes[axis] || cell_of_[cell_place(at)] < 0) continue;
        CrossedCell& other = cells_[cell_of_[cell_place(at)]];
        if (!is_double(other, 2 * axis)) continue;
        cell.turned = static_cast<std::uint8_t>(cell.turned ^ 1 << (2 * axis + 1));
        other.turned = static_cast<std::uint8_t>(other.turned ^ 1 << (2 * axis));
        find_sheets(cell);
        find_sheets(other);
        any = true;
      }
    }
    return any;
  }

  Eigen::RowVector3d crossing(const CrossedCell& cell, int edge) const {
    const auto [from, to] = tables_.edge_corners[edge];
    const double a = corner_number(cell.at, from);
    const double b = corner_number(cell.at, to);
    const double share = a / (a - b);
    Eigen::RowVector3d place(cell.at[0] + (from & 1), cell.at[1] + (from >> 1 & 1), cell.at[2] + (from >> 2 & 1));
    place(edge / 4) += share;
    return grid_.origin + grid_.spacing * place;
  }

  void place_vertices(Mesh& mesh) {
    Index count = 0;
    for (CrossedCell& cell : cells_) {
      cell.first_vertex = count;
      count += cell.sheets;
    }
    mesh.points = Points::Zero(count, 3);
    const auto place = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t c = begin; c < end; ++c) {
        const CrossedCell& cell = cells_[c];
        std::array<int, 4> counts{};
        for (int e = 0; e < 12; ++e) {
          if (cell.sheet[e] < 0) continue;
          mesh.points.row(cell.first_vertex + cell.sheet[e]) += crossing(cell, e);
          ++counts[cell.sheet[e]];
        }
        for (int s = 0; s < cell.sheets; ++s) mesh.points.row(cell.first_vertex + s) /= counts[s];
      }
    };
    parallel_for(static_cast<std::ptrdiff_t>(cells_.size()), place, 1024);
  }

  /// Each crossed edge once, from the cell of which it is the edge farthest from the origin.
  void join_quads(Mesh& mesh) const {
    for (const CrossedCell& cell : cells_) {
      for (int axis = 0; axis < 3; ++axis) {
        const int edge = 4 * axis + 3;
        if (cell.sheet[edge] < 0) continue;
        const int b = (axis + 1) % 3;
        const int c = (axis + 2) % 3;
        // Around the edge counter-clockwise seen from its end: the edge's number within each of the four cells.
        constexpr std::array<std::array<int, 2>, 4> kSteps = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        std::array<Index, 4> quad{};
        for (int r = 0; r < 4; ++r) {
          std::array<Index, 3> at = cell.at;
          at[b] += kSteps[r][0];
          at[c] += kSteps[r][1];
          const CrossedCell& near = cells_[cell_of_[cell_place(at)]];
          quad[r] = near.first_vertex + near.sheet[4 * axis + 3 - kSteps[r][0] - 2 * kSteps[r][1]];
        }
        const bool outwards = corner_number(cell.at, tables_.edge_corners[edge][0]) > 0.0;
        if (outwards) {
          mesh.add_face({quad[0], quad[1], quad[2], quad[3]});
        } else {
          mesh.add_face({quad[3], quad[2], quad[1], quad[0]});
        }
      }
    }
  }

  const ValueGrid& grid_;
  const CellTables& tables_;
  std::vector<CrossedCell> cells_;
  Buffer<Index> cell_of_;
};

}  // namespace

Mesh dual_contour(const ValueGrid& grid) { return Contour(grid).make(); }

}  // namespace batten
