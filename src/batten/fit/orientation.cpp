#include "batten/fit/orientation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <vector>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// The plane of one point: eigenvectors of the weighted covariance.
double plane_at(const Points& points, const NeighbourTable& neighbours, Index point, Eigen::RowVector3d& normal) {
  const Index count = neighbours.count;
  double reach = 0.0;
  for (Index k = 0; k < count; ++k) {
    if (neighbours.point(point, k) >= 0) reach = neighbours.distance(point, k);
  }
  const Eigen::RowVector3d base = points.row(point);
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double sum = 1.0;
  for (Index k = 0; k < count; ++k) {
    const Index other = neighbours.point(point, k);
    if (other < 0) break;
    const double share = reach > 0.0 ? neighbours.distance(point, k) / reach : 0.0;
    const double weight = std::exp(-1.5 * share * share);
    const Eigen::RowVector3d step = points.row(other) - base;
    mean += weight * step;
    squares += weight * step.transpose() * step;
    sum += weight;
  }
  mean /= sum;
  const Eigen::Matrix3d covariance = squares / sum - mean.transpose() * mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  normal = solver.eigenvectors().col(0).transpose();
  if (!normal.allFinite() || !(normal.squaredNorm() > 0.5)) normal = Eigen::RowVector3d::UnitZ();
  normal.normalize();
  const double total = solver.eigenvalues().sum();
  return total > 0.0 ? std::max(0.0, solver.eigenvalues()(0)) / total : 1.0 / 3.0;
}

/// A way from a point whose side is known to one whose side is not.
struct SideStep {
  double cost;
  Index to;
  bool same;  ///< the other normal keeps its side
  bool operator>(const SideStep& other) const { return cost != other.cost ? cost > other.cost : to > other.to; }
};

/// The neighbours of each point in both directions, in rows.
struct NeighbourGraph {
  Buffer<Index> starts;
  Buffer<Index> ends;
};

NeighbourGraph both_ways(const NeighbourTable& neighbours, Index size) {
  NeighbourGraph graph;
  graph.starts.assign(static_cast<std::size_t>(size) + 1, 0);
  const auto for_each_pair = [&](const auto& visit) {
    for (Index point = 0; point < size; ++point) {
      for (Index k = 0; k < neighbours.count && neighbours.point(point, k) >= 0; ++k)
        visit(point, neighbours.point(point, k));
    }
  };
  for_each_pair([&](Index a, Index b) {
    ++graph.starts[a + 1];
    ++graph.starts[b + 1];
  });
  for (Index point = 0; point < size; ++point) graph.starts[point + 1] += graph.starts[point];
  graph.ends.resize(static_cast<std::size_t>(graph.starts[size]));
  Buffer<Index> fill(graph.starts.begin(), graph.starts.end() - 1);
  for_each_pair([&](Index a, Index b) {
    graph.ends[fill[a]++] = b;
    graph.ends[fill[b]++] = a;
  });
  return graph;
}

/// The cost of handing the side on from one point to the other, and whether it is the same.
SideStep side_step(const Points& points, const Points& normals, Index from, Index to) {
  Eigen::RowVector3d along = points.row(to) - points.row(from);
  const double length = along.norm();
  if (length > 0.0) along /= length;
  const Eigen::RowVector3d a = normals.row(from);
  const Eigen::RowVector3d b = normals.row(to);
  const double agreement = a.dot(b) - 2.0 * along.dot(a) * along.dot(b);
  const double steep = std::max(std::abs(along.dot(a)), std::abs(along.dot(b)));
  return {1.0 - std::abs(agreement) + 0.1 * steep * steep, to, agreement >= 0.0};
}

std::vector<Index> parts_of_graph(const NeighbourGraph& graph, Index size, Index& count) {
  std::vector<Index> part(static_cast<std::size_t>(size), -1);
  std::vector<Index> stack;
  count = 0;
  for (Index start = 0; start < size; ++start) {
    if (part[start] >= 0) continue;
    part[start] = count;
    stack.push_back(start);
    while (!stack.empty()) {
      const Index point = stack.back();
      stack.pop_back();
      for (Index e = graph.starts[point]; e < graph.starts[point + 1]; ++e) {
        if (part[graph.ends[e]] >= 0) continue;
        part[graph.ends[e]] = count;
        stack.push_back(graph.ends[e]);
      }
    }
    ++count;
  }
  return part;
}

constexpr std::array<std::array<int, 3>, 7> kDirections = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}}};

/// Of each part the outermost point along one of a few directions whose normal lies most along it, turned outwards.
std::vector<Index> outermost_points(const Points& points, const std::vector<Index>& part, Index count,
                                    Points& normals) {
  std::vector<Index> best(static_cast<std::size_t>(count), -1);
  std::vector<double> best_fit(static_cast<std::size_t>(count), -1.0);
  for (const auto& numbers : kDirections) {
    const Eigen::RowVector3d axis = Eigen::RowVector3d(numbers[0], numbers[1], numbers[2]).normalized();
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::RowVector3d direction = sign * axis;
      std::vector<Index> outermost(static_cast<std::size_t>(count), -1);
      for (Index point = 0; point < static_cast<Index>(points.rows()); ++point) {
        Index& place = outermost[part[point]];
        if (place < 0 || points.row(point).dot(direction) > points.row(place).dot(direction)) place = point;
      }
      for (Index p = 0; p < count; ++p) {
        const double along = normals.row(outermost[p]).dot(direction);
        if (!(std::abs(along) > best_fit[p])) continue;
        best_fit[p] = std::abs(along);
        best[p] = outermost[p];
        if (along < 0.0) normals.row(outermost[p]) *= -1.0;
      }
    }
  }
  return best;
}

}  // namespace

LocalPlanes local_planes(const Points& points, const NeighbourTable& neighbours) {
  LocalPlanes planes;
  planes.normals.resize(points.rows(), 3);
  planes.roughness.resize(points.rows());
  const auto lay = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t row = begin; row < end; ++row) {
      Eigen::RowVector3d normal;
      planes.roughness(row) = plane_at(points, neighbours, static_cast<Index>(row), normal);
      planes.normals.row(row) = normal;
    }
  };
  parallel_for(points.rows(), lay, 512);
  return planes;
}

void orient_normals(const Points& points, const NeighbourTable& neighbours, Points& normals) {
  const auto size = static_cast<Index>(points.rows());
  const NeighbourGraph graph = both_ways(neighbours, size);
  Index count = 0;
  const std::vector<Index> part = parts_of_graph(graph, size, count);
  std::priority_queue<SideStep, std::vector<SideStep>, std::greater<>> steps;
  for (const Index start : outermost_points(points, part, count, normals)) steps.push({-1.0, start, true});
  std::vector<std::uint8_t> done(static_cast<std::size_t>(size), 0);
  std::vector<double> least(static_cast<std::size_t>(size), 10.0);
  while (!steps.empty()) {
    const SideStep step = steps.top();
    steps.pop();
    if (done[step.to] != 0) continue;
    done[step.to] = 1;
    if (!step.same) normals.row(step.to) *= -1.0;
    for (Index e = graph.starts[step.to]; e < graph.starts[step.to + 1]; ++e) {
      const Index other = graph.ends[e];
      if (done[other] != 0) continue;
      const SideStep next = side_step(points, normals, step.to, other);
      if (next.cost >= least[other]) continue;
      least[other] = next.cost;
      steps.push(next);
    }
  }
}

}  // namespace batten
