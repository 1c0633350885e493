#include "batten/fit/mapped_sphere.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "batten/energy/surface_energy.h"
#include "batten/error.h"
#include "batten/fit/first_mesh.h"
#include "batten/fit/normal_equations.h"
#include "batten/fit/point_tree.h"
#include "batten/fit/sphere_map.h"
#include "batten/fit/start_sphere.h"
#include "batten/fit/triangle_point.h"
#include "batten/mesh/topology.h"
#include "batten/nearest/nearest_point.h"
#include "batten/surface/surface_weights.h"

namespace batten {

namespace {

/// A place of the contour and where the surface shall be for it.
struct Anchor {
  std::array<Index, 3> corners;
  Eigen::Vector3d shares;
  Eigen::RowVector3d target;
  Eigen::Vector3d normal;
  Form form;  ///< how the distance from the target counts
};

Eigen::RowVector3d mixed(const Points& rows, const Anchor& anchor) {
  return anchor.shares[0] * rows.row(anchor.corners[0]) + anchor.shares[1] * rows.row(anchor.corners[1]) +
         anchor.shares[2] * rows.row(anchor.corners[2]);
}

/// The closed surface of the points as triangles, if they give one without handles.
std::optional<FirstMesh> sphere_like_contour(const PointCloud& cloud, Index vertices, const Progress& progress) {
  constexpr Index kLeast = 1500;
  constexpr Index kMost = 4000;
  FirstMeshOptions options;
  options.faces = FaceKind::Triangles;
  options.creases = CreaseSearch::Auto;
  options.vertices = std::clamp(2 * std::min(vertices, kMost), kLeast, kMost);
  try {
    FirstMesh contour = first_mesh(cloud, options, progress);
    if (contour.parts.size() == 1 && contour.genus() == 0 && contour.parts.front().boundary_loops == 0) return contour;
  } catch (const Error& error) {
    // Points that lie on no surface that could be found may still be near a sphere.
    if (error.code() == ErrorCode::Cancelled) throw;
  }
  return {};
}

/// Places in the middle of quarters of the triangles: they hold the parameters, and the surface where there are no
/// points.
std::vector<Anchor> anchors_of_triangles(const Mesh& contour) {
  constexpr double kHold = 0.1;
  std::vector<Anchor> anchors;
  double all = 0.0;
  for (Index f = 0; f < contour.face_count(); ++f) {
    const Index* const corners = contour.face_vertices.data() + contour.face_offsets[f];
    Anchor anchor{{corners[0], corners[1], corners[2]}, {}, {}, {}, {}};
    const Eigen::RowVector3d side = contour.points.row(corners[1]) - contour.points.row(corners[0]);
    const Eigen::RowVector3d other = contour.points.row(corners[2]) - contour.points.row(corners[0]);
    anchor.normal = side.cross(other).transpose();
    const double area = anchor.normal.norm();
    if (!(area > 0.0)) continue;
    anchor.normal /= area;
    anchor.form = kPointForm;
    scale(area, anchor.form);
    for (int quarter = 0; quarter < 4; ++quarter) {
      anchor.shares.setConstant(quarter < 3 ? 1.0 / 6.0 : 1.0 / 3.0);
      if (quarter < 3) anchor.shares[quarter] = 2.0 / 3.0;
      anchor.target = mixed(contour.points, anchor);
      anchors.push_back(anchor);
      all += area;
    }
  }
  for (Anchor& anchor : anchors) scale(kHold / all, anchor.form);
  return anchors;
}

/// Of the distance from a plane, and a little from the point.
Form nearly_plane_form(const Eigen::Vector3d& normal) {
  constexpr double kAlong = 0.05;
  const Eigen::Matrix3d form = (1.0 - kAlong) * normal * normal.transpose() + kAlong * Eigen::Matrix3d::Identity();
  return {form(0, 0), form(0, 1), form(0, 2), form(1, 1), form(1, 2), form(2, 2)};
}

/// The points, each at the nearest triangle that faces its way. middles: anchors_of_triangles().
std::vector<Anchor> anchors_of_points(const FirstMesh& contour, const std::vector<Anchor>& middles,
                                      const PointCloud& cloud) {
  constexpr Index kNear = 24;
  const Points& points = contour.mesh.points;
  Points places(static_cast<Eigen::Index>(middles.size()), 3);
  for (std::size_t i = 0; i < middles.size(); ++i) places.row(static_cast<Eigen::Index>(i)) = middles[i].target;
  const PointTree tree(std::move(places));
  std::vector<Anchor> anchors;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    std::array<Index, kNear> near{};
    std::array<double, kNear> squares{};
    const Eigen::RowVector3d target = cloud.points.row(i);
    const Eigen::Vector3d normal = cloud.normals.row(i).transpose();
    Anchor nearest{{}, {}, target, normal, {}};
    double least = -1.0;
    const Index found = tree.nearest(target, kNear, near.data(), squares.data());
    for (Index k = 0; k < found; ++k) {
      Anchor anchor = middles[near[k]];
      if (anchor.normal.dot(normal) < 0.0) continue;
      const Eigen::RowVector3d first = points.row(anchor.corners[0]);
      const Eigen::Vector2d shares =
          nearest_in_triangle((target - first).transpose(), (points.row(anchor.corners[1]) - first).transpose(),
                              (points.row(anchor.corners[2]) - first).transpose());
      anchor.shares << 1.0 - shares.sum(), shares[0], shares[1];
      const double square = (target - mixed(points, anchor)).squaredNorm();
      if (least >= 0.0 && square >= least) continue;
      least = square;
      nearest.corners = anchor.corners;
      nearest.shares = anchor.shares;
    }
    if (least < 0.0) continue;
    nearest.form = nearly_plane_form(normal);
    scale(1.0 / static_cast<double>(cloud.points.rows()), nearest.form);
    anchors.push_back(nearest);
  }
  return anchors;
}

/// The rotation of the map that brings it nearest to the rays from the middle of the ellipsoid around the points, by
/// the area of the contour: then the axes of the control mesh are those of the points.
Eigen::Matrix3d aligning_turn(const std::vector<Anchor>& middles, const Points& directions, const Points& points) {
  const PointEllipsoid around = ellipsoid_around(points);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Anchor& anchor : middles) {
    const Eigen::RowVector3d ray =
        (anchor.target * around.axes - around.middle).cwiseQuotient(around.half).normalized();
    sum += anchor.form[0] * mixed(directions, anchor).normalized().transpose() * ray;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d left = parts.matrixU();
  if ((left * parts.matrixV().transpose()).determinant() < 0.0) left.col(2) *= -1.0;
  return left * parts.matrixV().transpose();
}

/// Each value moves towards the mean of its neighbours'.
void diffuse(const Topology& topology, int rounds, Scalars& values) {
  for (int round = 0; round < rounds; ++round) {
    const Scalars before = values;
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      double sum = 0.0;
      Index count = 0;
      topology.for_each_outgoing(v, [&](Index h) {
        sum += before[topology.destination(h)];
        ++count;
      });
      values[v] = 0.5 * (before[v] + sum / count);
    }
  }
}

/// The sphere on its way over the points.
class SphereCover {
 public:
  SphereCover(const FirstMesh& contour, const PointCloud& cloud, Mesh sphere, SchemeKind kind)
      : topology_(contour.mesh),
        map_(contour.mesh),
        density_(Scalars::Ones(contour.mesh.vertex_count())),
        anchors_(anchors_of_triangles(contour.mesh)),
        held_(anchors_.size()),
        sphere_(std::move(sphere)),
        patches_(Topology(sphere_), scheme_of(kind)),
        weights_(patches_),
        nearest_(patches_, sphere_.points),
        equations_(SurfaceEnergy(patches_).matrix(EnergyKind::ThinPlate)) {
    const std::vector<Anchor> points = anchors_of_points(contour, anchors_, cloud);
    anchors_.insert(anchors_.end(), points.begin(), points.end());
    map_.relax(density_, kFirstSweeps);
    turn_ =
        aligning_turn(std::vector<Anchor>(anchors_.begin(), anchors_.begin() + held_), map_.directions(), cloud.points);
  }

  bool is_whole() const { return map_.turned_triangles() == 0; }

  /// Moves the control points so that the surface comes near the anchors.
  void fit() {
    constexpr double kFairness = 1e-5;
    constexpr double kDamping = 1e-9;
    constexpr double kTolerance = 1e-6;
    constexpr int kIterations = 500;
    const auto count = static_cast<Eigen::Index>(anchors_.size());
    Points directions(count, 3);
    std::vector<Form> forms;
    offsets_.resize(count, 3);
    for (std::size_t i = 0; i < anchors_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      directions.row(row) = mixed(map_.directions(), anchors_[i]).normalized() * turn_;
      offsets_.row(row) = anchors_[i].target;
      forms.push_back(anchors_[i].form);
    }
    const Eigen::RowVector3d middle = offsets_.topRows(static_cast<Eigen::Index>(held_)).colwise().mean();
    offsets_.rowwise() -= middle;
    std::vector<NearestPoint> found(anchors_.size());
    nearest_.nearest(directions, found);
    std::vector<SurfacePlace> places;
    places.reserve(found.size());
    for (const NearestPoint& point : found) places.push_back(point.place);
    const SurfaceWeights::Matrix rows = weights_.rows(places);
    equations_.assemble(rows, forms, offsets_);
    const Values none = Values::Zero(sphere_.points.rows(), 3);
    const double unit = 1.0 / equations_.energy().diagonal().sum();
    SolveReport solved;
    const Values control = equations_.solve(none, none, {unit * kFairness, 0.0, Scalars::Ones(none.rows()), kDamping},
                                            {kTolerance, kIterations, {}}, solved);
    offsets_ -= rows * control;
    sphere_.points = control.rowwise() + middle;
  }

  /// Gives more of the sphere to where points are far from the surface after fit().
  void adapt() {
    constexpr int kDiffusion = 8;
    constexpr int kSweeps = 10;
    constexpr double kPower = 0.175;
    constexpr double kLeast = 0.1;
    constexpr double kMost = 10.0;
    Scalars squares = Scalars::Zero(density_.size());
    Scalars counts = Scalars::Zero(density_.size());
    for (std::size_t i = held_; i < anchors_.size(); ++i) {
      const double distance = offsets_.row(static_cast<Eigen::Index>(i)).dot(anchors_[i].normal);
      for (int c = 0; c < 3; ++c) {
        squares[anchors_[i].corners[c]] += anchors_[i].shares[c] * distance * distance;
        counts[anchors_[i].corners[c]] += anchors_[i].shares[c];
      }
    }
    const double mean = squares.sum() / std::max(1.0, counts.sum());
    if (!(mean > 0.0)) return;
    diffuse(topology_, kDiffusion, squares);
    diffuse(topology_, kDiffusion, counts);
    for (Eigen::Index v = 0; v < density_.size(); ++v) {
      // As if a tenth of a point were at each vertex that is as far as the mean.
      const double here = (squares[v] + kLeast * mean) / (counts[v] + kLeast);
      density_[v] = std::clamp(density_[v] * std::pow(here / mean + kLeast, kPower), kLeast, kMost);
    }
    diffuse(topology_, 1, density_);
    map_.relax(density_, kSweeps);
  }

  Mesh result() { return std::move(sphere_); }

 private:
  static constexpr int kFirstSweeps = 20;
  static Scheme scheme_of(SchemeKind kind) {
    Scheme scheme;
    scheme.kind = kind;
    return scheme;
  }

  Topology topology_;  ///< of the contour
  SphereMap map_;
  Scalars density_;
  Eigen::Matrix3d turn_;         ///< from the map to the control mesh
  std::vector<Anchor> anchors_;  ///< of triangles, then of points
  std::size_t held_;             ///< so many of triangles
  Mesh sphere_;
  SurfacePatches patches_;
  SurfaceWeights weights_;
  NearestPoints nearest_;  ///< of the surface of the unit sphere's control points
  NormalEquations equations_;
  Points offsets_;  ///< from the surface to each anchor's target
};

}  // namespace

std::optional<Mesh> mapped_sphere(const PointCloud& cloud, SchemeKind kind, Index vertices, const Progress& progress) {
  constexpr int kRounds = 8;
  constexpr double kMapped = 0.6;
  const std::optional<FirstMesh> contour = sphere_like_contour(cloud, vertices, progress_within(progress, 0.0, 0.4));
  if (!contour) return {};
  SphereCover cover(*contour, cloud, unit_sphere(kind, vertices), kind);
  if (!cover.is_whole()) return {};
  cover.fit();
  for (int round = 0; round < kRounds; ++round) {
    report_progress(progress, kMapped + (1.0 - kMapped) * round / kRounds);
    cover.adapt();
    cover.fit();
  }
  return cover.result();
}

}  // namespace batten
