#include <array>
#include <cmath>
#include <numbers>

#include "shapes.h"

namespace batten::models {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// A vertex at the end of a mesh under construction.
Index add_point(std::vector<Vector3d>& points, const Vector3d& point) {
  points.push_back(point);
  return static_cast<Index>(points.size()) - 1;
}

Points to_points(const std::vector<Vector3d>& points) {
  Points rows(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  return rows;
}

/// Adds quads between two rings of a tube that runs from `from` to `to`. Both rings are clockwise seen along the tube.
void add_tube(Mesh& mesh, const std::vector<Index>& from, const std::vector<Index>& to) {
  const std::size_t n = from.size();
  for (std::size_t i = 0; i < n; ++i) mesh.add_face({from[i], to[i], to[(i + 1) % n], from[(i + 1) % n]});
}

/// Two pipes of radius 1 along x and y. Where they touch, their normals are equal and no fillet is needed.
double crossing_pipes(const Vector3d& p) {
  const double along_x = std::hypot(p.y(), p.z());
  const double along_y = std::hypot(p.x(), p.z());
  const double agreement = p.z() * p.z() / std::max(along_x * along_y, 1e-12);
  return blend(along_x - 1.0, along_y - 1.0, 0.9 * (1.0 - agreement));
}

/// The directions of the four pipes of a joint in the plane z = 0, a quarter turn apart.
Vector3d pipe_axis(int pipe) {
  constexpr std::array<int, 4> kCosines = {1, 0, -1, 0};
  return {static_cast<double>(kCosines[static_cast<std::size_t>(pipe % 4)]),
          static_cast<double>(kCosines[static_cast<std::size_t>((pipe + 3) % 4)]), 0.0};
}

/// `around` vertices around each pipe, an even number, and `rings` rings of quads along it.
Mesh joint(int around, int rings) {
  constexpr double kLength = 3.2;
  const Field field = crossing_pipes;
  const int half = around / 2;
  std::vector<Vector3d> points;
  // Seams between neighbouring pipes: half a ring each, with no vertex on the line x = y = 0, where all four pipes
  // meet.
  std::array<std::vector<Index>, 4> seams;
  const auto angle = [&](int i) { return kTurn * (i + 0.5) / around; };
  for (int pipe = 0; pipe < 4; ++pipe) {
    const Vector3d between = pipe_axis(pipe) + pipe_axis(pipe + 1);
    for (int i = 0; i < half; ++i)
      seams[static_cast<std::size_t>(pipe)].push_back(add_point(
          points,
          cast(field, Vector3d::Zero(), std::sin(angle(i)) * between + std::cos(angle(i)) * Vector3d::UnitZ())));
  }
  Mesh mesh;
  for (int pipe = 0; pipe < 4; ++pipe) {
    const Vector3d axis = pipe_axis(pipe);
    const Vector3d side = pipe_axis(pipe + 1);
    const auto& after = seams[static_cast<std::size_t>(pipe)];
    const auto& before = seams[static_cast<std::size_t>((pipe + 3) % 4)];
    std::vector<Index> ring = after;
    ring.insert(ring.end(), before.rbegin(), before.rend());
    const std::vector<Index> seam = ring;
    for (int r = 1; r <= rings; ++r) {
      std::vector<Index> next;
      for (int i = 0; i < around; ++i) {
        const double start = points[static_cast<std::size_t>(seam[static_cast<std::size_t>(i)])].dot(axis);
        const double t = static_cast<double>(r) / rings;
        const Vector3d centre = (start + (kLength - start) * t) * axis;
        next.push_back(
            add_point(points, cast(field, centre, std::sin(angle(i)) * side + std::cos(angle(i)) * Vector3d::UnitZ())));
      }
      add_tube(mesh, ring, next);
      ring = next;
    }
  }
  // Above and below, the four pipes leave a square open.
  mesh.add_face({seams[0][0], seams[1][0], seams[2][0], seams[3][0]});
  mesh.add_face({seams[3].back(), seams[2].back(), seams[1].back(), seams[0].back()});
  mesh.points = to_points(points);
  return mesh;
}

}  // namespace

Mesh pipe_joint() { return joint(12, 5); }

/// All diagonals have the same direction, so rounding decides nothing.
Mesh coarse_joint() {
  const Mesh quads = joint(8, 2);
  Mesh mesh;
  mesh.points = quads.points;
  for (std::size_t c = 0; c < quads.face_vertices.size(); c += 4) {
    const Index* corner = &quads.face_vertices[c];
    mesh.add_face({corner[0], corner[1], corner[2]});
    mesh.add_face({corner[0], corner[2], corner[3]});
  }
  return mesh;
}

namespace {

constexpr double kHubHeight = 1.75;
const Vector3d kHub(0.0, 0.0, kHubHeight);

Vector3d outwards(double third) {
  const double turn = kTurn * (third / 3.0 - 0.12);
  return {std::cos(turn), std::sin(turn), 0.0};
}

/// The middle line of a leg: it leaves the hub and then bends down to the foot.
Vector3d leg_line(double third, double t) {
  return kHub + 1.75 * std::sin(0.8 * t) / std::sin(0.8) * outwards(third) - 1.45 * t * t * Vector3d::UnitZ() -
         0.05 * t * Vector3d::UnitZ();
}

double leg_radius(double t) { return 0.50 - 0.22 * t; }

/// Spheres along the leg, close enough to form a tube.
double leg(double third, const Vector3d& p) {
  double nearest = 1e9;
  for (int i = 0; i <= 200; ++i) {
    const double t = i / 200.0;
    nearest = std::min(nearest, (p - leg_line(third, t)).norm() - leg_radius(t));
  }
  return nearest;
}

double three_legs(const Vector3d& p) { return blend(blend(leg(0.0, p), leg(1.0, p), 0.5), leg(2.0, p), 0.5); }

/// The middle line's direction and the directions across it: to the left seen from the hub, and up.
struct LegFrame {
  Vector3d along;
  Vector3d left;
  Vector3d up;
};

LegFrame leg_frame(double third, double t) {
  LegFrame frame;
  frame.along = (leg_line(third, t + 1e-4) - leg_line(third, t - 1e-4)).normalized();
  frame.left = Vector3d::UnitZ().cross(outwards(third));
  frame.up = frame.along.cross(frame.left);
  return frame;
}

constexpr int kLegAround = 8;
constexpr int kLegRings = 8;

double leg_angle(int i) { return kTurn * i / kLegAround; }

/// Adds ring `ring` in 1 to kLegRings - 1 down the leg. The first ones are tilted like the joint's seam; the last is
/// half way around the foot.
std::vector<Index> add_leg_ring(std::vector<Vector3d>& points, double third, int ring) {
  std::vector<Index> vertices;
  for (int i = 0; i < kLegAround; ++i) {
    const double down = std::min(1.0, static_cast<double>(ring - 1) / (kLegRings - 2));
    const double start = 0.34 - 0.05 * std::cos(leg_angle(i));
    const double t = start + (1.0 - start) * down;
    const LegFrame frame = leg_frame(third, t);
    const Vector3d across = std::cos(leg_angle(i)) * frame.up + std::sin(leg_angle(i)) * frame.left;
    const Vector3d tilt = ring == kLegRings ? frame.along : Vector3d(Vector3d::Zero());
    vertices.push_back(add_point(points, cast(three_legs, leg_line(third, t), across + tilt)));
  }
  return vertices;
}

}  // namespace

Mesh tripod() {
  const Field field = three_legs;
  std::vector<Vector3d> points;
  // Between legs k and k + 1 there are three vertices, from top to bottom. Each leg has one above and one below, and
  // there are two poles.
  std::array<std::array<Index, 3>, 3> seams;
  std::array<Index, 3> above;
  std::array<Index, 3> below;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto third = static_cast<double>(k);
    for (int i = 0; i < 3; ++i) {
      const double rise = leg_angle(1 - i);
      seams[k][static_cast<std::size_t>(i)] = add_point(
          points, cast(field, kHub, std::cos(rise) * outwards(third + 0.5) + std::sin(rise) * Vector3d::UnitZ()));
    }
    above[k] = add_point(points, cast(field, kHub, 0.5 * outwards(third) + Vector3d::UnitZ()));
    below[k] = add_point(points, cast(field, kHub, 0.3 * outwards(third) - Vector3d::UnitZ()));
  }
  const Index top = add_point(points, cast(field, kHub, Vector3d::UnitZ()));
  const Index bottom = add_point(points, cast(field, kHub, -Vector3d::UnitZ()));
  Mesh mesh;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto third = static_cast<double>(k);
    const std::size_t previous = (k + 2) % 3;
    // Starts above and goes over the left, counter-clockwise seen against the leg's direction.
    std::vector<Index> ring = {above[k], seams[k][0],        seams[k][1],        seams[k][2],
                               below[k], seams[previous][2], seams[previous][1], seams[previous][0]};
    for (int r = 1; r <= kLegRings; ++r) {
      const std::vector<Index> next = add_leg_ring(points, third, r);
      add_tube(mesh, ring, next);
      ring = next;
    }
    const Index tip = add_point(points, cast(field, leg_line(third, 1.0), leg_frame(third, 1.0).along));
    for (std::size_t i = 0; i < 8; i += 2) mesh.add_face({tip, ring[(i + 2) % 8], ring[i + 1], ring[i]});
    mesh.add_face({top, above[k], seams[k][0], above[(k + 1) % 3]});
    mesh.add_face({bottom, below[(k + 1) % 3], seams[k][2], below[k]});
  }
  mesh.points = to_points(points);
  return mesh;
}

Mesh torus_knot() {
  constexpr int kAlong = 72;
  constexpr int kAround = 8;
  constexpr double kRadius = 0.52;
  Mesh mesh;
  mesh.points.resize(kAlong * kAround, 3);
  // On the torus of radii 2 and 1, twice around the hole and three times through it.
  const auto curve = [](double t) {
    const double distance = 2.0 + std::cos(3.0 * t);
    return Vector3d(distance * std::cos(2.0 * t), distance * std::sin(2.0 * t), std::sin(3.0 * t));
  };
  for (int i = 0; i < kAlong; ++i) {
    const double t = kTurn * i / kAlong;
    const Vector3d along = (curve(t + 1e-4) - curve(t - 1e-4)).normalized();
    // The torus's own normal returns to itself after a round, so the tube needs no untwisting.
    const Vector3d out(std::cos(3.0 * t) * std::cos(2.0 * t), std::cos(3.0 * t) * std::sin(2.0 * t), std::sin(3.0 * t));
    const Vector3d first = (out - out.dot(along) * along).normalized();
    const Vector3d second = along.cross(first);
    for (int j = 0; j < kAround; ++j) {
      const double turn = kTurn * j / kAround;
      mesh.points.row(i * kAround + j) =
          (curve(t) + kRadius * (std::cos(turn) * first + std::sin(turn) * second)).transpose();
      const int next = (i + 1) % kAlong * kAround;
      mesh.add_face({i * kAround + j, i * kAround + (j + 1) % kAround, next + (j + 1) % kAround, next + j});
    }
  }
  return mesh;
}

}  // namespace batten::models
