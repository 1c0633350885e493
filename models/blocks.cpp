#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "shapes.h"

namespace batten::models {
namespace {

using Cell = std::array<int, 3>;
using Solid = std::function<bool(const Cell&)>;

/// The surface of a set of unit cells: quads between full and empty cells, with vertices at integer points.
struct Skin {
  Mesh mesh;
  std::vector<Cell> corners;  ///< the integer point of each vertex
  std::map<Cell, Index> vertices;

  Index vertex(const Cell& corner) {
    const auto [place, fresh] = vertices.emplace(corner, static_cast<Index>(corners.size()));
    if (fresh) corners.push_back(corner);
    return place->second;
  }
};

Skin skin_of(const Solid& solid, const Cell& lowest, const Cell& highest) {
  Skin skin;
  Cell cell;
  for (cell[0] = lowest[0]; cell[0] <= highest[0]; ++cell[0]) {
    for (cell[1] = lowest[1]; cell[1] <= highest[1]; ++cell[1]) {
      for (cell[2] = lowest[2]; cell[2] <= highest[2]; ++cell[2]) {
        if (!solid(cell)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const int side : {0, 1}) {
            Cell beyond = cell;
            beyond[axis] += 2 * side - 1;
            if (solid(beyond)) continue;
            // Counter-clockwise seen from +axis; the opposite order for the lower side.
            const std::size_t u = (axis + 1) % 3;
            const std::size_t v = (axis + 2) % 3;
            std::array<Index, 4> quad{};
            for (std::size_t k = 0; k < 4; ++k) {
              Cell corner = cell;
              corner[axis] += side;
              corner[u] += k == 1 || k == 2 ? 1 : 0;
              corner[v] += k >= 2 ? 1 : 0;
              quad[side == 1 ? k : 3 - k] = skin.vertex(corner);
            }
            skin.mesh.add_face({quad[0], quad[1], quad[2], quad[3]});
          }
        }
      }
    }
  }
  skin.mesh.points.resize(static_cast<Eigen::Index>(skin.corners.size()), 3);
  for (std::size_t i = 0; i < skin.corners.size(); ++i)
    skin.mesh.points.row(static_cast<Eigen::Index>(i)) << skin.corners[i][0], skin.corners[i][1], skin.corners[i][2];
  return skin;
}

bool within(const Cell& cell, const Cell& lowest, const Cell& highest) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (cell[i] < lowest[i] || cell[i] > highest[i]) return false;
  }
  return true;
}

}  // namespace

namespace {

constexpr std::array<double, 6> kBracketX = {0.0, 0.5, 1.25, 2.0, 2.75, 3.5};
constexpr std::array<double, 6> kBracketY = {0.0, 0.65, 1.3, 1.7, 2.35, 3.0};
constexpr std::array<double, 6> kBracketZ = {0.0, 0.5, 1.25, 2.0, 2.75, 3.5};
constexpr double kHoleRadius = 0.36;

bool bracket_cell(const Cell& cell) {
  const bool foot = within(cell, {0, 0, 0}, {4, 4, 0});
  const bool back = within(cell, {0, 0, 0}, {0, 4, 4});
  const bool rib = within(cell, {1, 2, 1}, {2, 2, 2}) && cell != Cell{2, 2, 2};
  return foot || back || rib;
}

/// Polygons during construction, and the vertices around holes with their side (1 or 2).
struct Draft {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<Index>> faces;
  std::map<Index, int> hole_side;
};

int sign(double x) { return std::abs(x) < 1e-9 ? 0 : (x > 0.0 ? 1 : -1); }

/// Replaces the four quads around `centre` by eight around an octagon. Returns the octagon's vertices by their
/// direction.
std::map<std::array<int, 3>, Index> cut_octagon(Draft& draft, Index centre, int side) {
  const Eigen::Vector3d middle = draft.points[static_cast<std::size_t>(centre)];
  std::map<std::array<int, 3>, Index> ring;
  const auto inner = [&](Index outer) {
    const Eigen::Vector3d way = draft.points[static_cast<std::size_t>(outer)] - middle;
    const std::array<int, 3> key = {sign(way.x()), sign(way.y()), sign(way.z())};
    const auto [place, fresh] = ring.emplace(key, static_cast<Index>(draft.points.size()));
    if (fresh) {
      draft.points.push_back(middle + kHoleRadius * Eigen::Vector3d(key[0], key[1], key[2]).normalized());
      draft.hole_side[place->second] = side;
    }
    return place->second;
  };
  std::vector<std::vector<Index>> kept;
  for (const std::vector<Index>& face : draft.faces) {
    const auto at = std::find(face.begin(), face.end(), centre);
    if (at == face.end()) {
      kept.push_back(face);
      continue;
    }
    const auto first = static_cast<std::size_t>(at - face.begin());
    for (std::size_t k = 1; k <= 2; ++k) {
      const Index a = face[(first + k) % 4];
      const Index b = face[(first + k + 1) % 4];
      kept.push_back({a, b, inner(b), inner(a)});
    }
  }
  draft.faces = kept;
  return ring;
}

/// Makes a hole through a plate from a vertex of one face to one of the other. `turn` lists the eight directions around
/// the axis, counter-clockwise seen from `front`.
void drill(Draft& draft, Index front, Index back, const std::array<std::array<int, 3>, 8>& turn) {
  const auto near = cut_octagon(draft, front, 1);
  const auto far = cut_octagon(draft, back, 2);
  for (std::size_t k = 0; k < 8; ++k) {
    const auto& a = turn[k];
    const auto& b = turn[(k + 1) % 8];
    draft.faces.push_back({near.at(a), near.at(b), far.at(b), far.at(a)});
  }
}

Eigen::Vector3d normal_of(const Draft& draft, const std::vector<Index>& face) {
  const auto at = [&](std::size_t k) { return draft.points[static_cast<std::size_t>(face[k])]; };
  return (at(2) - at(0)).cross(at(3) - at(1)).normalized();
}

/// Convex edges stay sharp forever, concave ones get a fillet, and the walls of the holes are round.
std::vector<Crease> bracket_creases(const Draft& draft) {
  std::map<std::pair<Index, Index>, std::size_t> face_of;
  for (std::size_t f = 0; f < draft.faces.size(); ++f) {
    for (std::size_t k = 0; k < 4; ++k) face_of[{draft.faces[f][k], draft.faces[f][(k + 1) % 4]}] = f;
  }
  std::vector<Crease> creases;
  for (const auto& entry : face_of) {
    const Index a = entry.first.first;
    const Index b = entry.first.second;
    if (a > b) continue;
    const Eigen::Vector3d left = normal_of(draft, draft.faces[entry.second]);
    const Eigen::Vector3d right = normal_of(draft, draft.faces[face_of.at({b, a})]);
    const auto side_a = draft.hole_side.find(a);
    const auto side_b = draft.hole_side.find(b);
    const bool wall =
        side_a != draft.hole_side.end() && side_b != draft.hole_side.end() && side_a->second != side_b->second;
    if (wall || left.dot(right) > 0.77) continue;
    const Eigen::Vector3d along = draft.points[static_cast<std::size_t>(b)] - draft.points[static_cast<std::size_t>(a)];
    creases.push_back({a, b, left.cross(right).dot(along) > 0.0 ? 10.0 : 2.5});
  }
  return creases;
}

/// The draft as a mesh without unused vertices.
Mesh finished(Draft draft) {
  std::vector<Index> renumbered(draft.points.size(), -1);
  std::vector<Eigen::Vector3d> points;
  for (auto& face : draft.faces) {
    for (Index& vertex : face) {
      Index& number = renumbered[static_cast<std::size_t>(vertex)];
      if (number < 0) {
        number = static_cast<Index>(points.size());
        points.push_back(draft.points[static_cast<std::size_t>(vertex)]);
      }
    }
  }
  Mesh mesh;
  for (Crease crease : bracket_creases(draft)) {
    crease.a = renumbered[static_cast<std::size_t>(crease.a)];
    crease.b = renumbered[static_cast<std::size_t>(crease.b)];
    mesh.creases.push_back(crease);
  }
  for (const auto& face : draft.faces) {
    for (const Index vertex : face) mesh.face_vertices.push_back(renumbered[static_cast<std::size_t>(vertex)]);
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  mesh.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) mesh.points.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  return mesh;
}

}  // namespace

Mesh bracket() {
  Skin skin = skin_of(bracket_cell, {0, 0, 0}, {4, 4, 4});
  Draft draft;
  for (const Cell& corner : skin.corners) {
    Eigen::Vector3d point(kBracketX[static_cast<std::size_t>(corner[0])],
                          kBracketY[static_cast<std::size_t>(corner[1])],
                          kBracketZ[static_cast<std::size_t>(corner[2])]);
    // The rib's two steps become one slope, x + z = 2.5.
    const bool rib = corner[0] >= 2 && corner[2] >= 2;
    if (rib && corner[0] == 3) point = {1.625, point.y(), 0.875};
    if (rib && corner[2] == 3) point = {0.875, point.y(), 1.625};
    draft.points.push_back(point);
  }
  for (Index f = 0; f < skin.mesh.face_count(); ++f)
    draft.faces.emplace_back(skin.mesh.face_vertices.begin() + 4 * f, skin.mesh.face_vertices.begin() + 4 * f + 4);
  using Turn = std::array<std::array<int, 3>, 8>;
  const Turn about_z = {{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {0, -1, 0}, {1, -1, 0}}};
  const Turn about_x = {{{0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {0, -1, 1}, {0, -1, 0}, {0, -1, -1}, {0, 0, -1}, {0, 1, -1}}};
  for (const int y : {1, 4}) {
    drill(draft, skin.vertices.at({4, y, 1}), skin.vertices.at({4, y, 0}), about_z);
    drill(draft, skin.vertices.at({1, y, 4}), skin.vertices.at({0, y, 4}), about_x);
  }
  Mesh mesh = finished(std::move(draft));
  // The front is -y, so the foot points towards the viewer.
  const Eigen::VectorXd x = mesh.points.col(0);
  mesh.points.col(0) = mesh.points.col(1).array() - 1.5;
  mesh.points.col(1) = -x;
  return mesh;
}

namespace {

double ball(const Eigen::Vector3d& p, const Eigen::Vector3d& centre, double radius) {
  return (p - centre).norm() - radius;
}

double capsule(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - radius;
}

constexpr int kFineness = 2;  ///< cells per unit of the creature

/// x to the creature's left, y backwards, z up.
bool creature_cell(const Cell& cell) {
  Cell unit;
  for (std::size_t i = 0; i < 3; ++i) unit[i] = (cell[i] + 100 * kFineness) / kFineness - 100;
  const bool body = within(unit, {0, 0, 1}, {2, 4, 3});
  const bool leg = unit[2] == 0 && unit[0] != 1 && (unit[1] == 0 || unit[1] == 4) && within(unit, {0, 0, 0}, {2, 4, 0});
  const bool head = within(unit, {0, -2, 3}, {2, 0, 5});
  const bool snout = unit == Cell{1, -3, 3};
  const bool ear = unit[2] == 6 && unit[1] == -1 && (unit[0] == 0 || unit[0] == 2);
  const bool tail = unit == Cell{1, 5, 3};
  return body || leg || head || snout || ear || tail;
}

double creature_field(const Eigen::Vector3d& point) {
  // The point is mirrored, so that the field has only one of each leg and ear.
  const Eigen::Vector3d p(std::abs(point.x() - 1.5), point.y(), point.z());
  double field = capsule(p, {0, 1.3, 2.4}, {0, 3.6, 2.5}, 1.5);
  for (const double y : {0.75, 4.2}) field = blend(field, capsule(p, {0.85, y, 1.6}, {0.95, y, 0.35}, 0.58), 0.5);
  field = blend(field, ball(p, {0, -0.5, 4.5}, 1.7), 0.6);
  field = blend(field, ball(p, {0, -2.1, 4.0}, 0.75), 0.5);
  field = blend(field, capsule(p, {0.95, -0.5, 5.6}, {1.25, -0.45, 6.35}, 0.50), 0.4);
  return blend(field, capsule(p, {0, 4.6, 3.3}, {0, 5.6, 3.8}, 0.46), 0.5);
}

}  // namespace

Mesh creature() {
  Skin skin = skin_of(creature_cell, {0, -3 * kFineness, 0}, {3 * kFineness, 6 * kFineness, 7 * kFineness});
  Points& points = skin.mesh.points;
  points /= kFineness;
  std::map<Index, std::vector<Index>> neighbours;
  for (Index c = 0; c < static_cast<Index>(skin.mesh.face_vertices.size()); ++c)
    neighbours[skin.mesh.face_vertices[c]].push_back(skin.mesh.face_vertices[c / 4 * 4 + (c + 1) % 4]);
  // Alternates between spreading the vertices evenly and moving them onto the shape.
  for (int round = 0; round < 16; ++round) {
    const Points old = points;
    for (const auto& [vertex, others] : neighbours) {
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const Index other : others) mean += old.row(other).transpose() / static_cast<double>(others.size());
      const Eigen::Vector3d moved = old.row(vertex).transpose() + 0.4 * (mean - old.row(vertex).transpose());
      points.row(vertex) = settle(creature_field, moved).transpose();
    }
  }
  points.col(0).array() -= 1.5;
  // The left half is exactly the mirror image of the right half.
  for (std::size_t i = 0; i < skin.corners.size(); ++i) {
    Cell mirrored = skin.corners[i];
    mirrored[0] = 3 * kFineness - mirrored[0];
    const Index twin = skin.vertices.at(mirrored);
    const auto vertex = static_cast<Index>(i);
    if (mirrored[0] < skin.corners[i][0]) points.row(vertex) << -points(twin, 0), points(twin, 1), points(twin, 2);
    if (twin == vertex) points(vertex, 0) = 0.0;
  }
  return skin.mesh;
}

}  // namespace batten::models
