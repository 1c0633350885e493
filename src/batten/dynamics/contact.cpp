#include "batten/dynamics/contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "batten/dynamics/force_checks.h"
#include "batten/dynamics/surface_samples.h"
#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/released_memory.h"

namespace batten {

namespace {

/// A ball around an element's control points, and so around its surface.
struct Ball {
  Eigen::Vector3d center;
  double radius = 0.0;
};

Ball ball_around(std::span<const Index> vertices, const Points& base) {
  Eigen::Vector3d low = base.row(vertices[0]);
  Eigen::Vector3d high = low;
  for (const Index v : vertices) {
    low = low.cwiseMin(base.row(v).transpose());
    high = high.cwiseMax(base.row(v).transpose());
  }
  Ball ball{0.5 * (low + high)};
  double squared = 0.0;
  for (const Index v : vertices) squared = std::max(squared, (base.row(v).transpose() - ball.center).squaredNorm());
  ball.radius = std::sqrt(squared);
  return ball;
}

std::vector<Ball> balls_around(const FaceElements& elements, const Points& base) {
  std::vector<Ball> balls(static_cast<std::size_t>(elements.count()));
  parallel_for(
      elements.count(),
      [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        for (auto e = static_cast<Index>(first); e < static_cast<Index>(last); ++e) {
          balls[e] = ball_around(elements.vertices(e), base);
        }
      },
      1024);
  return balls;
}

}  // namespace

/// A place that is too near.
struct Contact::Touch {
  std::ptrdiff_t sample;
  double stiffness;  ///< of the place
  double depth;      ///< above 0
  Eigen::Vector3d normal;
  Eigen::Vector3d point;
};

Contact::Contact(const ElasticSurface& body, SignedDistance obstacle, const ContactOptions& options)
    : obstacle_(std::move(obstacle)),
      options_(options),
      samples_(std::make_shared<const SurfaceSamples>(body.patches(), GridSamples{options.intervals})),
      face_areas_(element_areas(body.patches(), body.rest())) {
  release_freed_memory(sizeof(double) * static_cast<std::size_t>(body.mass().nonZeros()));
  if (!obstacle_) throw Error(ErrorCode::BadArgument, "a contact needs an obstacle");
  require_not_negative(options_.stiffness, "the stiffness of a contact");
  require_not_negative(options_.friction, "the friction of a contact");
  require_not_negative(options_.thickness, "the thickness of a contact");
}

double Contact::distance(const Eigen::Vector3d& point, Eigen::Vector3d& gradient) const {
  const double distance = obstacle_(point, gradient);
  if (std::isfinite(distance)) return distance;
  throw Error(ErrorCode::NotFinite, "the distance of an obstacle from " + describe(point) + " is not finite");
}

std::vector<Contact::Touch> Contact::find_touches(const Points& positions) const {
  const Points base = samples_->base_points(positions);
  const std::vector<Ball> balls = balls_around(samples_->elements(), base);
  std::vector<Touch> touches;
  Points places;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (Index e = 0; e < samples_->elements().count(); ++e) {
    if (distance(balls[e].center, gradient) > balls[e].radius + options_.thickness) continue;
    const JetTable& table = samples_->table(e);
    places.resize(static_cast<Eigen::Index>(table.places.size()), 3);
    samples_->evaluate_element(e, base, places.data());
    const double total = table.places.empty() ? 0.0 : samples_->patches().quads() ? 1.0 : 0.5;
    for (Eigen::Index i = 0; i < places.rows(); ++i) {
      const Eigen::Vector3d point = places.row(i);
      const double depth = options_.thickness - distance(point, gradient);
      if (depth <= 0.0) continue;
      if (!gradient.allFinite()) throw not_finite(gradient, "the gradient of an obstacle at " + describe(point));
      if (gradient.isZero(0.0))
        throw Error(ErrorCode::BadArgument, "the gradient of an obstacle at " + describe(point) + " is 0");
      const double area = face_areas_[e] * table.weights[static_cast<std::size_t>(i)] / total;
      touches.push_back({samples_->begin(e) + i, options_.stiffness * area, depth, gradient.stableNormalized(), point});
    }
  }
  return touches;
}

void Contact::add(const ForceInput& input, ForceSum& sum) const {
  const std::vector<Touch> touches = find_touches(input.positions);
  if (touches.empty()) return;
  const auto count = static_cast<Eigen::Index>(touches.size());
  std::vector<std::ptrdiff_t> samples(touches.size());
  std::transform(touches.begin(), touches.end(), samples.begin(), [](const Touch& touch) { return touch.sample; });
  PlaceSprings springs{samples_->point_rows(samples), Scalars(count), Points(count, 3), false, Points(count, 3)};
  const bool rubs = options_.friction > 0.0 && input.step > 0.0;
  const Points starts = rubs ? Points(springs.rows->rows * input.start) : Points();
  Points slipping = Points::Zero(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Touch& touch = touches[static_cast<std::size_t>(i)];
    springs.stiffness[i] = touch.stiffness;
    springs.targets.row(i) = touch.point + touch.depth * touch.normal;
    springs.directions.row(i) = touch.normal;
    sum.energy += 0.5 * touch.stiffness * touch.depth * touch.depth;
    if (!rubs) continue;
    Eigen::Vector3d slip = touch.point - starts.row(i).transpose();
    slip -= touch.normal.dot(slip) * touch.normal;
    const double most = options_.friction * touch.depth;
    if (slip.norm() <= most) {
      springs.targets.row(i) -= slip;
      springs.directions.row(i).setZero();
    } else {
      slipping.row(i) = -touch.stiffness * most * slip.normalized();
    }
  }
  if (rubs) sum.force += springs.rows->transposed * slipping;
  sum.springs.push_back(std::move(springs));
}

std::shared_ptr<const Force> Contact::refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const {
  return std::make_shared<Contact>(child, obstacle_, options_);
}

}  // namespace batten
