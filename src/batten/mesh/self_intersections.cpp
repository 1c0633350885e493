#include "batten/mesh/self_intersections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/mesh/face_normal.h"
#include "batten/mesh/face_triangles.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr int kFanout = 8;
/// Vectors of eight lanes; what comparisons make has all bits of a lane, or none.
using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
using Doubles = double __attribute__((vector_size(64)));
using Longs = std::int64_t __attribute__((vector_size(64)));

/// A bit for each lane that holds.
template <typename Lanes>
unsigned bits_of(Lanes lanes) {
  lanes &= Lanes{1, 2, 4, 8, 16, 32, 64, 128};
  unsigned bits = 0;
  for (int i = 0; i < kFanout; ++i) bits |= static_cast<unsigned>(lanes[i]);
  return bits;
}

struct Box {
  std::array<float, 3> low;
  std::array<float, 3> high;

  static Box empty() {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    return {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  }
  /// Meets no box, and adds nothing to one.
  static Box none() {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    return {{kNan, kNan, kNan}, {kNan, kNan, kNan}};
  }
  void add(const Box& other) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], other.low[c]);
      high[c] = std::max(high[c], other.high[c]);
    }
  }
};

/// Boxes side by side.
struct EightBoxes {
  std::array<Floats, 3> low;
  std::array<Floats, 3> high;

  void set(int lane, const Box& box) {
    for (int c = 0; c < 3; ++c) {
      low[c][lane] = box.low[c];
      high[c][lane] = box.high[c];
    }
  }
  Box get(int lane) const {
    return {{low[0][lane], low[1][lane], low[2][lane]}, {high[0][lane], high[1][lane], high[2][lane]}};
  }
  /// A bit for each that meets the other box.
  unsigned meeting(const Box& other) const {
    return bits_of((low[0] <= other.high[0]) & (high[0] >= other.low[0]) & (low[1] <= other.high[1]) &
                   (high[1] >= other.low[1]) & (low[2] <= other.high[2]) & (high[2] >= other.low[2]));
  }
};

struct BoxedTriangle {
  std::array<Index, 3> vertices;
  Index face;
};

/// Triangles side by side.
struct EightTriangles {
  std::array<Ints, 3> vertices;
  std::array<std::array<Doubles, 3>, 3> corners;  ///< of each corner its coordinates
};

/// Spreads the 21 bits of a number to every third bit.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffULL;
  x = (x | x << 16) & 0x1f0000ff0000ffULL;
  x = (x | x << 8) & 0x100f00f00f00f00fULL;
  x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
  return (x | x << 2) & 0x1249249249249249ULL;
}

/// Triangles in the order of a space-filling curve, eight a group, below levels of boxes, each of which encloses eight
/// of the level below.
class TriangleTree {
 public:
  TriangleTree(const Topology& topology, ConstValuesRef points) : points_(points) {
    const FaceTriangles triangles(topology, points);
    triangles_.resize(static_cast<std::size_t>(triangles.count()));
    parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto f = static_cast<Index>(begin); f < end; ++f) {
        for (Index k = 0; k + 2 < topology.face_size(f); ++k)
          triangles_[triangles.first_of(f) + k] = {triangles.vertices(f, k), f};
      }
    });
    sort();
    gather();
    add_level(count(), [&](std::ptrdiff_t t) { return box_of(triangles_[t]); });
    while (levels_.back().size() > 1) {
      const Buffer<EightBoxes>& below = levels_.back();
      add_level(static_cast<std::ptrdiff_t>(below.size()), [&](std::ptrdiff_t i) { return around(below[i]); });
    }
  }

  std::ptrdiff_t count() const { return static_cast<std::ptrdiff_t>(triangles_.size()); }
  std::ptrdiff_t group_count() const { return static_cast<std::ptrdiff_t>(groups_.size()); }
  static std::ptrdiff_t first_of(std::ptrdiff_t group) { return group * kFanout; }
  std::ptrdiff_t end_of(std::ptrdiff_t group) const { return std::min(first_of(group + 1), count()); }
  const BoxedTriangle& triangle(std::ptrdiff_t t) const { return triangles_[t]; }
  /// In the last group the last triangle stands for those that are missing.
  const EightTriangles& group(std::ptrdiff_t g) const { return groups_[g]; }

  /// Calls visit(t, g, bits) for the triangles t of a group and each group g with triangles, a bit each, that come
  /// after t in the order and whose boxes meet that of t. The group goes down the tree as one.
  template <typename Visit>
  void behind(std::ptrdiff_t group, const Visit& visit) const {
    const EightBoxes& own = levels_[0][group];
    const Box all = around(own);
    struct Node {
      int level;
      std::ptrdiff_t place;
    };
    std::array<Node, kFanout * 24> stack;
    int used = 0;
    stack[used++] = {static_cast<int>(levels_.size()) - 1, 0};
    while (used > 0) {
      const Node node = stack[--used];
      const EightBoxes& boxes = levels_[static_cast<std::size_t>(node.level)][node.place];
      if (node.level > 0) {
        for (unsigned bits = boxes.meeting(all); bits != 0; bits &= bits - 1) {
          const std::ptrdiff_t child = node.place * kFanout + std::countr_zero(bits);
          if (last_group(node.level - 1, child) >= group) stack[used++] = {node.level - 1, child};
        }
        continue;
      }
      for (std::ptrdiff_t t = first_of(group); t < end_of(group); ++t) {
        const int lane = static_cast<int>(t - first_of(group));
        unsigned bits = boxes.meeting(own.get(lane));
        if (node.place == group) bits &= ~((2U << lane) - 1);
        if (bits != 0) visit(t, node.place, bits);
      }
    }
  }

 private:
  Eigen::RowVector3d at(Index v) const { return points_.row(v); }

  /// The last group below a place in a level; the groups themselves are level 0.
  static std::ptrdiff_t last_group(int level, std::ptrdiff_t place) {
    constexpr int kFanoutBits = 3;
    static_assert(kFanout == 1 << kFanoutBits);
    return ((place + 1) << (kFanoutBits * level)) - 1;
  }

  /// The bounds rounded outwards to float.
  Box box_of(const BoxedTriangle& triangle) const {
    constexpr double kUlp = std::numeric_limits<float>::epsilon();
    constexpr double kLeast = std::numeric_limits<float>::min();
    constexpr double kMost = std::numeric_limits<float>::max();
    Box box;
    for (int c = 0; c < 3; ++c) {
      const double x = points_(triangle.vertices[0], c);
      const double y = points_(triangle.vertices[1], c);
      const double z = points_(triangle.vertices[2], c);
      const double low = std::min({x, y, z});
      const double high = std::max({x, y, z});
      box.low[c] = static_cast<float>(std::min(low - kUlp * std::abs(low) - kLeast, kMost));
      box.high[c] = static_cast<float>(std::max(high + kUlp * std::abs(high) + kLeast, -kMost));
    }
    return box;
  }

  void sort() {
    if (triangles_.empty()) return;
    const Eigen::RowVector3d low = points_.colwise().minCoeff();
    const double size = std::max((points_.colwise().maxCoeff() - low).maxCoeff(), std::numeric_limits<double>::min());
    Buffer<std::pair<std::uint64_t, Index>> keys(triangles_.size());
    parallel_for(count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t t = begin; t < end; ++t) {
        const std::array<Index, 3>& v = triangles_[t].vertices;
        const Eigen::RowVector3d middle = ((at(v[0]) + at(v[1]) + at(v[2])) / 3.0 - low) / size;
        std::uint64_t key = 0;
        for (int c = 0; c < 3; ++c)
          key |= spread(static_cast<std::uint64_t>(std::clamp(middle[c], 0.0, 1.0) * 2097151.0)) << c;
        keys[t] = {key, static_cast<Index>(t)};
      }
    });
    std::sort(keys.begin(), keys.end());
    Buffer<BoxedTriangle> sorted(triangles_.size());
    for (std::size_t t = 0; t < keys.size(); ++t) sorted[t] = triangles_[keys[t].second];
    triangles_.swap(sorted);
  }

  void gather() {
    groups_.resize(static_cast<std::size_t>((count() + kFanout - 1) / kFanout));
    parallel_for(static_cast<std::ptrdiff_t>(groups_.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t g = begin; g < end; ++g) {
        for (int lane = 0; lane < kFanout; ++lane) {
          const BoxedTriangle& triangle = triangles_[std::min(first_of(g) + lane, count() - 1)];
          for (int i = 0; i < 3; ++i) {
            groups_[g].vertices[i][lane] = triangle.vertices[i];
            for (int c = 0; c < 3; ++c) groups_[g].corners[i][c][lane] = points_(triangle.vertices[i], c);
          }
        }
      }
    });
  }

  static Box around(const EightBoxes& boxes) {
    Box box = Box::empty();
    for (int lane = 0; lane < kFanout; ++lane) box.add(boxes.get(lane));
    return box;
  }

  /// box(i): of number i of the level below.
  template <typename BoxOf>
  void add_level(std::ptrdiff_t below, const BoxOf& box) {
    Buffer<EightBoxes> level(static_cast<std::size_t>((below + kFanout - 1) / kFanout));
    parallel_for(static_cast<std::ptrdiff_t>(level.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        for (int lane = 0; lane < kFanout; ++lane) {
          const std::ptrdiff_t child = i * kFanout + lane;
          level[i].set(lane, child < below ? box(child) : Box::none());
        }
      }
    });
    levels_.push_back(std::move(level));
  }

  ConstValuesRef points_;
  Buffer<BoxedTriangle> triangles_;
  Buffer<EightTriangles> groups_;
  std::vector<Buffer<EightBoxes>> levels_;
};

bool same_sign(double a, double b, double c) {
  return (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
}

/// The plane of three points.
class Plane {
 public:
  Plane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : from_(a), normal_((b - a).cross(c - a)), most_((b - a).lpNorm<1>() * (c - a).lpNorm<1>()) {}

  /// Six times the volume of the tetrahedron with a fourth point, or 0 if rounding could have changed its sign.
  double volume(const Eigen::Vector3d& d) const {
    const Eigen::Vector3d w = d - from_;
    const double value = normal_.dot(w);
    return std::abs(value) > kRounding * most_ * w.lpNorm<1>() ? value : 0.0;
  }

  /// A bit for each triangle that lies on one side, but for corners that are also `shared`: it meets no triangle of the
  /// plane but in such a corner.
  unsigned beside(const EightTriangles& triangles, const std::array<Index, 3>& shared) const {
    Longs above{};
    Longs below{};
    const auto size = [](const Doubles& x) { return x < 0.0 ? -x : x; };
    for (int i = 0; i < 3; ++i) {
      const Ints& v = triangles.vertices[i];
      const Longs other = __builtin_convertvector((v != shared[0]) & (v != shared[1]) & (v != shared[2]), Longs);
      const Doubles x = triangles.corners[i][0] - from_[0];
      const Doubles y = triangles.corners[i][1] - from_[1];
      const Doubles z = triangles.corners[i][2] - from_[2];
      const Doubles value = normal_[0] * x + normal_[1] * y + normal_[2] * z;
      const Doubles least = kRounding * most_ * (size(x) + size(y) + size(z));
      above |= other & (value >= -least);
      below |= other & (value <= least);
    }
    return bits_of(~(above & below));
  }

 private:
  static constexpr double kRounding = 32.0 * std::numeric_limits<double>::epsilon();

  Eigen::Vector3d from_;
  Eigen::Vector3d normal_;
  double most_;
};

/// A triangle that others are tried against.
class TriangleTest {
 public:
  TriangleTest(ConstValuesRef points, const std::array<Index, 3>& vertices)
      : points_(points), vertices_(vertices), plane_(at(vertices[0]), at(vertices[1]), at(vertices[2])) {}

  /// A bit for each triangle that cannot cross this one, as it lies on one side of its plane.
  unsigned beside(const EightTriangles& triangles) const { return plane_.beside(triangles, vertices_); }

  /// True where the other shares no edge with this one and an edge of one passes through the other.
  bool crosses(const std::array<Index, 3>& other) const {
    std::array<bool, 3> shared;
    for (int i = 0; i < 3; ++i) shared[i] = has(other[i]);
    if (shared[0] + shared[1] + shared[2] > 1) return false;
    std::array<double, 3> sides;
    for (int i = 0; i < 3; ++i) sides[i] = shared[i] ? 0.0 : plane_.volume(at(other[i]));
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if (!shared[i] && !shared[j] && passes(sides[i], sides[j], at(other[i]), at(other[j]))) return true;
    }
    const TriangleTest back(points_, other);
    for (int i = 0; i < 3; ++i) {
      const Index from = vertices_[i];
      const Index to = vertices_[(i + 1) % 3];
      if (back.has(from) || back.has(to)) continue;
      if (back.passes(back.plane_.volume(at(from)), back.plane_.volume(at(to)), at(from), at(to))) return true;
    }
    return false;
  }

 private:
  Eigen::Vector3d at(Index v) const { return points_.row(v).transpose(); }
  bool has(Index v) const { return v == vertices_[0] || v == vertices_[1] || v == vertices_[2]; }

  /// True if an edge whose ends are on these sides of the plane passes through the triangle.
  bool passes(double side, double other_side, const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    if (!(side < 0.0 && other_side > 0.0) && !(side > 0.0 && other_side < 0.0)) return false;
    const auto turn = [&](int i) { return Plane(from, to, at(vertices_[i])).volume(at(vertices_[(i + 1) % 3])); };
    return same_sign(turn(0), turn(1), turn(2));
  }

  ConstValuesRef points_;
  std::array<Index, 3> vertices_;
  Plane plane_;
};

}  // namespace

SelfIntersections find_self_intersections(const Topology& topology, ConstValuesRef points, const Progress& progress,
                                          Index most_listed) {
  require_vertex_rows(topology, points);
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "intersections need points of three columns");
  if (!points.allFinite()) throw Error(ErrorCode::NotFinite, "the points hold a number that is not finite");
  report_progress(progress, 0.0);
  const TriangleTree tree(topology, points);
  constexpr std::ptrdiff_t kBlock = 32;
  const auto search = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    SelfIntersections found;
    std::vector<TriangleTest> tests;
    for (std::ptrdiff_t group = begin; group < end; ++group) {
      const std::ptrdiff_t first = TriangleTree::first_of(group);
      tests.clear();
      for (std::ptrdiff_t t = first; t < tree.end_of(group); ++t) tests.emplace_back(points, tree.triangle(t).vertices);
      tree.behind(group, [&](std::ptrdiff_t t, std::ptrdiff_t others, unsigned bits) {
        const TriangleTest& test = tests[static_cast<std::size_t>(t - first)];
        const Index own = tree.triangle(t).face;
        for (bits &= ~test.beside(tree.group(others)); bits != 0; bits &= bits - 1) {
          const BoxedTriangle& second = tree.triangle(TriangleTree::first_of(others) + std::countr_zero(bits));
          if (second.face == own || !test.crosses(second.vertices)) continue;
          ++found.count;
          found.faces.push_back({std::min(own, second.face), std::max(own, second.face)});
        }
      });
    }
    return found;
  };
  const auto combine = [most = static_cast<std::size_t>(most_listed)](SelfIntersections a, const SelfIntersections& b) {
    a.count += b.count;
    a.faces.insert(a.faces.end(), b.faces.begin(), b.faces.end());
    std::sort(a.faces.begin(), a.faces.end());
    if (a.faces.size() > most) a.faces.resize(most);
    return a;
  };
  SelfIntersections all = parallel_reduce(tree.group_count(), SelfIntersections(), search, combine, kBlock,
                                          progress_within(progress, 0.2, 1.0));
  return combine(SelfIntersections(), all);
}

Index count_turned_faces(const Topology& topology, ConstValuesRef before, ConstValuesRef after) {
  require_vertex_rows(topology, before);
  require_vertex_rows(topology, after);
  const auto turned = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Index count = 0;
    for (auto f = static_cast<Index>(begin); f < end; ++f)
      count += face_normal(topology, before, f).dot(face_normal(topology, after, f)) < 0.0 ? 1 : 0;
    return count;
  };
  return parallel_reduce(topology.face_count(), Index{0}, turned, [](Index a, Index b) { return a + b; });
}

}  // namespace batten
