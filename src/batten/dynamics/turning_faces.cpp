#include "batten/dynamics/turning_faces.h"

#include <numeric>
#include <utility>

#include "batten/dynamics/rotation.h"
#include "batten/energy/face_elements.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr std::ptrdiff_t kTurnBlock = 256;

}  // namespace

void TurningFaces::add(const FaceElements& elements, const Buffer<double>& gradients, const Points& rest) {
  const bool first = starts_.size() == 1;
  Buffer<std::size_t> starts{0};
  Buffer<Part> parts;
  parts.reserve(parts_.size() + elements.vertices().size());
  for (Index e = 0; e < elements.count(); ++e) {
    const std::size_t begin = parts.size();
    if (!first) parts.insert(parts.end(), parts_.begin() + starts_[e], parts_.begin() + starts_[e + 1]);
    const std::size_t known = parts.size();
    const double* gradient = gradients.data() + 3 * elements.start(e);
    std::size_t next = begin;  // elements of two energies mostly list the same vertices
    for (const Index v : elements.vertices(e)) {
      const Eigen::Map<const Eigen::RowVector3d> g(gradient);
      gradient += 3;
      rest_energy_ += 0.5 * g.dot(rest.row(v));
      if (next < known && parts[next].vertex != v) {
        for (next = begin; next < known && parts[next].vertex != v;) ++next;
      }
      if (next < known) {
        parts[next++].gradient += g;
      } else {
        parts.push_back({v, g});
      }
    }
    starts.push_back(parts.size());
  }
  starts_ = std::move(starts);
  parts_ = std::move(parts);
}

void TurningFaces::finish(Index vertex_count) {
  first_uses_.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (const Part& part : parts_) ++first_uses_[part.vertex + 1];
  std::partial_sum(first_uses_.begin(), first_uses_.end(), first_uses_.begin());
  uses_.resize(parts_.size());
  Buffer<std::size_t> next(first_uses_.begin(), first_uses_.end() - 1);
  for (std::size_t e = 0; e + 1 < starts_.size(); ++e) {
    for (std::size_t i = starts_[e]; i < starts_[e + 1]; ++i) {
      uses_[next[parts_[i].vertex]++] = {static_cast<Index>(e), parts_[i].gradient};
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
            a += points.row(parts_[i].vertex).transpose() * parts_[i].gradient;
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
            force += rotations[uses_[i].element] * uses_[i].gradient.transpose();
          }
          result->row(v) = force;
        }
      },
      kTurnBlock);
  return sum;
}

}  // namespace batten
