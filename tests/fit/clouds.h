/// \file Clouds of points on known surfaces.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "batten/fit/first_mesh.h"

namespace batten::test {

/// Random points, by rejection where a density is given.
class CloudMaker {
 public:
  explicit CloudMaker(unsigned seed = 1) : random_(seed) {}
  double uniform(double low = 0.0, double high = 1.0) { return low + (high - low) * share_(random_); }
  Eigen::RowVector3d direction() {
    const double z = uniform(-1.0, 1.0);
    const double angle = uniform(0.0, 2.0 * std::numbers::pi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  Points sphere(Index count, double radius = 1.0) {
    Points points(count, 3);
    for (Index i = 0; i < count; ++i) points.row(i) = radius * direction();
    return points;
  }
  Eigen::RowVector3d on_torus(double radius, double tube) {
    for (;;) {
      const double u = uniform(0.0, 2.0 * std::numbers::pi);
      const double v = uniform(0.0, 2.0 * std::numbers::pi);
      const double out = radius + tube * std::cos(v);
      if (uniform() * (radius + tube) < out) return {out * std::cos(u), out * std::sin(u), tube * std::sin(v)};
    }
  }
  Points torus(Index count, double radius = 1.0, double tube = 0.35) {
    Points points(count, 3);
    for (Index i = 0; i < count; ++i) points.row(i) = on_torus(radius, tube);
    return points;
  }
  /// Two tori side by side without what is inside the other: genus 2.
  Points double_torus(Index count) {
    Points points(count, 3);
    for (Index i = 0; i < count;) {
      const double side = i % 2 == 0 ? 1.0 : -1.0;
      Eigen::RowVector3d place = on_torus(1.0, 0.3);
      place(0) += side;
      const double out = std::hypot(place(0) + side, place(1)) - 1.0;
      if (out * out + place(2) * place(2) < 0.09) continue;
      points.row(i++) = place;
    }
    return points;
  }
  /// Adds points anywhere in the box.
  Points with_outliers(const Points& points, double share) {
    const auto extra = static_cast<Index>(share * static_cast<double>(points.rows()));
    const Eigen::RowVector3d low = points.colwise().minCoeff();
    const Eigen::RowVector3d high = points.colwise().maxCoeff();
    Points all(points.rows() + extra, 3);
    all.topRows(points.rows()) = points;
    for (Index i = 0; i < extra; ++i) {
      for (Index c = 0; c < 3; ++c) all(points.rows() + i, c) = uniform(low(c), high(c));
    }
    return all;
  }
  Points shuffled(const Points& points) {
    std::vector<Index> order(static_cast<std::size_t>(points.rows()));
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
    std::shuffle(order.begin(), order.end(), random_);
    Points moved(points.rows(), 3);
    for (std::size_t i = 0; i < order.size(); ++i) moved.row(static_cast<Eigen::Index>(i)) = points.row(order[i]);
    return moved;
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> share_{0.0, 1.0};
};

/// Where the real clouds lie; empty where they are not to be had.
inline std::string cloud_folder() {
  const char* const data = std::getenv("BATTEN_DATA");
  return data == nullptr ? "" : std::string(data) + "/points/";
}

}  // namespace batten::test
