#include "batten/fit/winding_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace batten {

namespace {

constexpr Index kWindingLeaf = 8;
constexpr double kOpening = 2.5;

}  // namespace

WindingField::WindingField(const Points& points, const Points& normals, const Scalars& areas, const Scalars& widths) {
  const auto size = static_cast<Index>(points.rows());
  order_.resize(static_cast<std::size_t>(size));
  for (Index row = 0; row < size; ++row) order_[row] = row;
  pieces_.resize(static_cast<std::size_t>(size));
  for (Index row = 0; row < size; ++row) {
    for (Index c = 0; c < 3; ++c) {
      pieces_[row].at[c] = points(row, c);
      pieces_[row].area[c] = areas(row) * normals(row, c) / (4.0 * std::numbers::pi);
    }
    pieces_[row].width_square = widths(row) * widths(row);
  }
  if (size > 0) build(0, size, points);
  const Buffer<Piece> sorted = [&] {
    Buffer<Piece> moved(pieces_.size());
    for (Index row = 0; row < size; ++row) moved[row] = pieces_[order_[row]];
    return moved;
  }();
  pieces_ = sorted;
}

WindingField::Node WindingField::summed(Index begin, Index end) const {
  Node node{};
  double weight = 0.0;
  for (Index i = begin; i < end; ++i) {
    const Piece& piece = pieces_[order_[i]];
    const double area = std::hypot(piece.area[0], piece.area[1], piece.area[2]) + 1e-300;
    for (int c = 0; c < 3; ++c) {
      node.sum.at[c] += area * piece.at[c];
      node.sum.area[c] += piece.area[c];
    }
    node.sum.width_square += area * piece.width_square;
    weight += area;
  }
  for (double& number : node.sum.at) number /= weight;
  node.sum.width_square /= weight;
  double radius = 0.0;
  for (Index i = begin; i < end; ++i) {
    const Piece& piece = pieces_[order_[i]];
    double square = 0.0;
    for (int c = 0; c < 3; ++c) square += (piece.at[c] - node.sum.at[c]) * (piece.at[c] - node.sum.at[c]);
    radius = std::max(radius, square);
  }
  node.reach_square = kOpening * kOpening * radius;
  node.begin = begin;
  node.end = end;
  return node;
}

Index WindingField::build(Index begin, Index end, const Points& points) {
  const auto number = static_cast<Index>(nodes_.size());
  nodes_.push_back(summed(begin, end));
  if (end - begin > kWindingLeaf) {
    Eigen::RowVector3d low = points.row(order_[begin]);
    Eigen::RowVector3d high = low;
    for (Index i = begin; i < end; ++i) {
      low = low.cwiseMin(points.row(order_[i]));
      high = high.cwiseMax(points.row(order_[i]));
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const Index middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](Index a, Index b) {
      return points(a, axis) != points(b, axis) ? points(a, axis) < points(b, axis) : a < b;
    });
    nodes_[number].begin = -1;
    build(begin, middle, points);
    build(middle, end, points);
  }
  nodes_[number].skip = static_cast<Index>(nodes_.size());
  return number;
}

double WindingField::part(const Piece& piece, const Eigen::RowVector3d& place) {
  const double x = piece.at[0] - place(0);
  const double y = piece.at[1] - place(1);
  const double z = piece.at[2] - place(2);
  const double square = x * x + y * y + z * z + piece.width_square;
  return (piece.area[0] * x + piece.area[1] * y + piece.area[2] * z) / (square * std::sqrt(square));
}

Eigen::RowVector3d WindingField::fall_part(const Piece& piece, const Eigen::RowVector3d& place) {
  const Eigen::RowVector3d area(piece.area[0], piece.area[1], piece.area[2]);
  const Eigen::RowVector3d way = Eigen::RowVector3d(piece.at[0], piece.at[1], piece.at[2]) - place;
  const double square = way.squaredNorm() + piece.width_square;
  return (area - 3.0 * area.dot(way) / square * way) / (square * std::sqrt(square));
}

template <typename Sum, typename Part>
void WindingField::add(const Eigen::RowVector3d& place, Sum& sum, const Part& part) const {
  const auto count = static_cast<Index>(nodes_.size());
  for (Index at = 0; at < count;) {
    const Node& node = nodes_[at];
    const double x = node.sum.at[0] - place(0);
    const double y = node.sum.at[1] - place(1);
    const double z = node.sum.at[2] - place(2);
    if (x * x + y * y + z * z > node.reach_square) {
      sum += part(node.sum, place);
      at = node.skip;
    } else if (node.begin >= 0) {
      for (Index i = node.begin; i < node.end; ++i) sum += part(pieces_[i], place);
      at = node.skip;
    } else {
      ++at;
    }
  }
}

double WindingField::value(const Eigen::RowVector3d& place) const {
  double sum = 0.0;
  add(place, sum, part);
  return sum;
}

Eigen::RowVector3d WindingField::fall(const Eigen::RowVector3d& place) const {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  add(place, sum, fall_part);
  return sum;
}

}  // namespace batten
