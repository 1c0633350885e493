/// \file An elastic surface that the page pulls at.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "batten/dynamics/elastic_motion.h"
#include "studio/engine/mesh_file.h"

namespace batten::studio {

/// The material and what acts besides the hand, all in the units of the surface, which is 1 across.
struct ElasticWishes {
  double tension = 100.0;
  double rigidity = 1.0;
  double damping = 1.0;
  double pressure = 0.0;
  double gravity = 0.0;
  bool floor = false;         ///< a plane below the body
  bool hold_boundary = true;  ///< where there is one; otherwise springs hold the body at its place, as a bed of foam
};

/// Lengths are scaled so that the body is 1 across: the sliders then mean the same for every mesh.
class Elastic {
 public:
  Elastic(const std::shared_ptr<const MeshFile>& file, const Scheme& scheme, const ElasticWishes& wishes);

  /// The spring from the place of the surface nearest to a point, to where the hand is.
  val grab(double x, double y, double z, double stiffness);
  val pull(double x, double y, double z);
  val release();
  /// So many steps of 1/60 s: {time}.
  val step(int count);
  /// Holds the place of the surface nearest to a point where it is now: {point}.
  val pin(double x, double y, double z);
  /// Goes on with the control mesh refined once: the same surface, which can bend more finely.
  val refine();
  /// In the file's unit.
  Points control_points() const;
  /// The same as doubles.
  val control() const;
  /// The body as a control mesh with all that hung on it: a MeshFile.
  val control_file() const;

 private:
  void rebuild();
  Eigen::Vector3d inward(double x, double y, double z) const;

  Mesh mesh_;  ///< of the body's connectivity; its points are not those of now
  UpAxis up_;
  Topology topology_;
  Scheme scheme_;
  ElasticWishes wishes_;
  double scale_;
  Eigen::RowVector3d centre_;
  std::optional<ElasticSurface> body_;
  std::vector<std::shared_ptr<const Force>> lasting_;
  Supports supports_;
  std::optional<ElasticMotion> motion_;
  ElasticState state_;
  std::shared_ptr<Eigen::Vector3d> hand_;
  std::shared_ptr<const Force> spring_;
};

/// wishes: as ElasticWishes, and scheme: {kind, boundary}.
val make_elastic(const std::shared_ptr<MeshFile>& file, const val& wishes);

}  // namespace batten::studio
