#include "batten/mesh/self_intersections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/mesh/face_normal.h"
#include "batten/mesh/face_triangles.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr int kFanout = 8;

struct Box {
  std::array<float, 3> low;
  std::array<float, 3> high;

  static Box empty() {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    return {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  }
  void add(const Box& other) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], other.low[c]);
      high[c] = std::max(high[c], other.high[c]);
    }
  }
  bool meets(const Box& other) const {
    bool apart = false;
    for (int c = 0; c < 3; ++c) apart = apart || low[c] > other.high[c] || other.low[c] > high[c];
    return !apart;
  }
};

struct BoxedTriangle {
  std::array<Index, 3> vertices;
  Index face;
};

/// Spreads the 21 bits of a number to every third bit.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffULL;
  x = (x | x << 16) & 0x1f0000ff0000ffULL;
  x = (x | x << 8) & 0x100f00f00f00f00fULL;
  x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
  return (x | x << 2) & 0x1249249249249249ULL;
}

/// Triangles in the order of a space-filling curve, below levels of boxes, each of which encloses eight of the level
/// below.
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
    Buffer<Box> boxes(triangles_.size());
    parallel_for(count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t t = begin; t < end; ++t) boxes[t] = box_of(triangles_[t]);
    });
    levels_.push_back(std::move(boxes));
    while (levels_.back().size() > 1) add_level();
  }

  std::ptrdiff_t count() const { return static_cast<std::ptrdiff_t>(triangles_.size()); }
  const BoxedTriangle& triangle(std::ptrdiff_t t) const { return triangles_[t]; }

  /// Calls visit(t, other) for the triangles of group g, those from kFanout * g on, and the triangles after each in the
  /// order whose boxes meet. The group goes down the tree as one.
  template <typename Visit>
  void behind(std::ptrdiff_t g, const Visit& visit) const {
    const std::ptrdiff_t first = g * kFanout;
    const std::ptrdiff_t end = std::min(first + kFanout, count());
    Box own = Box::empty();
    for (std::ptrdiff_t t = first; t < end; ++t) own.add(levels_[0][t]);
    struct Node {
      int level;
      std::ptrdiff_t place;
    };
    std::array<Node, kFanout * 24> stack;
    int used = 0;
    stack[used++] = {static_cast<int>(levels_.size()) - 1, 0};
    while (used > 0) {
      const Node node = stack[--used];
      if (node.level == 0) {
        for (std::ptrdiff_t t = first; t < std::min(end, node.place); ++t) {
          if (levels_[0][t].meets(levels_[0][node.place])) visit(t, node.place);
        }
        continue;
      }
      const Buffer<Box>& below = levels_[node.level - 1];
      const auto last = std::min<std::ptrdiff_t>((node.place + 1) * kFanout, static_cast<std::ptrdiff_t>(below.size()));
      for (std::ptrdiff_t i = node.place * kFanout; i < last; ++i) {
        if (last_below(node.level - 1, i) > first && below[i].meets(own)) stack[used++] = {node.level - 1, i};
      }
    }
  }

  /// How many groups behind() knows.
  std::ptrdiff_t groups() const { return (count() + kFanout - 1) / kFanout; }

 private:
  Eigen::RowVector3d at(Index v) const { return points_.row(v); }

  static std::ptrdiff_t last_below(int level, std::ptrdiff_t place) {
    std::ptrdiff_t width = 1;
    for (int i = 0; i < level; ++i) width *= kFanout;
    return (place + 1) * width - 1;
  }

  /// The bounds rounded outwards to float.
  Box box_of(const BoxedTriangle& triangle) const {
    Box box = Box::empty();
    for (const Index v : triangle.vertices) {
      for (int c = 0; c < 3; ++c) {
        const double x = points_(v, c);
        const auto near = static_cast<float>(x);
        constexpr float kFar = std::numeric_limits<float>::infinity();
        box.low[c] = std::min(box.low[c], near > x ? std::nextafter(near, -kFar) : near);
        box.high[c] = std::max(box.high[c], near < x ? std::nextafter(near, kFar) : near);
      }
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

  void add_level() {
    const Buffer<Box>& below = levels_.back();
    Buffer<Box> above((below.size() + kFanout - 1) / kFanout, Box::empty());
    for (std::size_t i = 0; i < below.size(); ++i) above[i / kFanout].add(below[i]);
    levels_.push_back(std::move(above));
  }

  ConstValuesRef points_;
  Buffer<BoxedTriangle> triangles_;
  std::vector<Buffer<Box>> levels_;
};

/// Six times the volume of the tetrahedron, or 0 if rounding could have changed its sign.
double volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  constexpr double kRounding = 32.0 * std::numeric_limits<double>::epsilon();
  const Eigen::Vector3d u = b - a;
  const Eigen::Vector3d v = c - a;
  const Eigen::Vector3d w = d - a;
  const double value = u.cross(v).dot(w);
  const double most = u.lpNorm<1>() * v.lpNorm<1>() * w.lpNorm<1>();
  return std::abs(value) > kRounding * most ? value : 0.0;
}

bool same_sign(double a, double b, double c) {
  return (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
}

class PairTest {
 public:
  explicit PairTest(ConstValuesRef points) : points_(points) {}

  bool cross(const std::array<Index, 3>& a, const std::array<Index, 3>& b) const {
    int shared = 0;
    for (const Index v : a) shared += std::count(b.begin(), b.end(), v) > 0 ? 1 : 0;
    return shared < 2 && (edges_cross(a, b) || edges_cross(b, a));
  }

 private:
  Eigen::Vector3d at(Index v) const { return points_.row(v).transpose(); }

  /// True if an edge of `a` without a corner of `b` passes through b.
  bool edges_cross(const std::array<Index, 3>& a, const std::array<Index, 3>& b) const {
    for (int i = 0; i < 3; ++i) {
      const Index from = a[i];
      const Index to = a[(i + 1) % 3];
      if (std::count(b.begin(), b.end(), from) > 0 || std::count(b.begin(), b.end(), to) > 0) continue;
      const double side = volume(at(b[0]), at(b[1]), at(b[2]), at(from));
      const double other = volume(at(b[0]), at(b[1]), at(b[2]), at(to));
      const bool through = (side < 0.0 && other > 0.0) || (side > 0.0 && other < 0.0);
      if (!through) continue;
      if (same_sign(volume(at(from), at(to), at(b[0]), at(b[1])), volume(at(from), at(to), at(b[1]), at(b[2])),
                    volume(at(from), at(to), at(b[2]), at(b[0]))))
        return true;
    }
    return false;
  }

  ConstValuesRef points_;
};

}  // namespace

SelfIntersections find_self_intersections(const Topology& topology, ConstValuesRef points, const Progress& progress,
                                          Index most_listed) {
  require_vertex_rows(topology, points);
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "intersections need points of three columns");
  if (!points.allFinite()) throw Error(ErrorCode::NotFinite, "the points hold a number that is not finite");
  report_progress(progress, 0.0);
  const TriangleTree tree(topology, points);
  const PairTest test(points);
  constexpr std::ptrdiff_t kBlock = 32;
  const auto search = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    SelfIntersections found;
    for (std::ptrdiff_t g = begin; g < end; ++g) {
      tree.behind(g, [&](std::ptrdiff_t t, std::ptrdiff_t other) {
        const BoxedTriangle& own = tree.triangle(t);
        const BoxedTriangle& second = tree.triangle(other);
        if (second.face == own.face || !test.cross(own.vertices, second.vertices)) return;
        ++found.count;
        found.faces.push_back({std::min(own.face, second.face), std::max(own.face, second.face)});
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
  SelfIntersections all =
      parallel_reduce(tree.groups(), SelfIntersections(), search, combine, kBlock, progress_within(progress, 0.2, 1.0));
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
