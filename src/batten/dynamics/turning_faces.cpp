#include "batten/dynamics/turning_faces.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "batten/dynamics/rotation.h"
#include "batten/energy/face_elements.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr std::ptrdiff_t kTurnBlock = 256;

}  // namespace

void TurningFaces::Parts::reserve(std::size_t count) {
  vertices.reserve(count);
  gradients.reserve(3 * count);
}

void TurningFaces::Parts::add(Index vertex, const Eigen::RowVector3d& gradient) {
  vertices.push_back(vertex);
  gradients.insert(gradients.end(), gradient.data(), gradient.data() + 3);
}

void TurningFaces::add(const FaceElements& elements, const Buffer<double>& gradients, const Points& rest) {
  const bool first = starts_.size() == 1;
  Buffer<std::size_t> starts{0};
  Parts parts;
  parts.reserve(std::max(parts_.size(), elements.vertices().size()));  // most are in both
  for (Index e = 0; e < elements.count(); ++e) {
    const std::size_t begin = parts.size();
    for (std::size_t i = first ? 0 : starts_[e]; i < (first ? 0 : starts_[e + 1]); ++i) {
      parts.add(parts_.vertices[i], parts_.gradient(i));
    }
    const std::size_t known = parts.size();
    const double* gradient = gradients.data() + 3 * elements.start(e);
    std::size_t next = begin;  // elements of two energies mostly list the same vertices
    for (const Index v : elements.vertices(e)) {
      const Eigen::Map<const Eigen::RowVector3d> g(gradient);
      gradient += 3;
      rest_energy_ += 0.5 * g.dot(rest.row(v));
      if (next < known && parts.vertices[next] != v) {
        for (next = begin; next < known && parts.vertices[next] != v;) ++next;
      }
      if (next < known) {
        parts.gradient(next++) += g;
      } else {
        parts.add(v, g);
      }
    }
    starts.push_back(parts.size());
  }
  starts_ = std::move(starts);
  parts_ = std::move(parts);
}

void TurningFaces::finish(Index vertex_count) {
  first_uses_.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (const Index v : parts_.vertices) ++first_uses_[v + 1];
  std::partial_sum(first_uses_.begin(), first_uses_.end(), first_uses_.begin());
  uses_.resize(parts_.size());
  Buffer<std::size_t> next(first_uses_.begin(), first_uses_.end() - 1);
  for (std::size_t e = 0; e + 1 < starts_.size(); ++e) {
    for (std::size_t i = starts_[e]; i < starts_[e + 1]; ++i) {
      uses_[next[parts_.vertices[i]]++] = {static_cast<Index>(e), static_cast<Index>(i)};
    }
  }
}

double TurningFaces::turn(const Points& points, Points* result) const {
  Buffer<Eigen::Matrix3d> rotations(starts_.size() - 1);
  const double sum = parallel_reduce(
      static_cast<std::ptrdiff_t>(rotations.size()), 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double traces = 0.0;
        for (std::ptrdiff_t e = begin; e < end; ++e) {
          Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
          for (std::size_t i = starts_[e]; i < starts_[e + 1]; ++i) {
            a += points.row(parts_.vertices[i]).transpose() * parts_.gradient(i);
          }
          const BestRotation best = best_rotation(a);
          rotations[e] = best.matrix;
          traces += best.trace;
        }
        return traces;
      },
      [](double a, double b) { return a + b; }, kTurnBlock);
  if (result == nullptr) return sum;
  result->resize(points.rows(), 3);
  parallel_for(
      points.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t v = begin; v < end; ++v) {
          Eigen::Vector3d force = Eigen::Vector3d::Zero();
          for (std::size_t i = first_uses_[v]; i < first_uses_[v + 1]; ++i) {
            force += rotations[uses_[i].element] * parts_.gradient(uses_[i].part).transpose();
          }
          result->row(v) = force;
        }
      },
      kTurnBlock);
  return sum;
}

}  // namespace batten
