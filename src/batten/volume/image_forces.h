/// \file What an image does to an elastic surface: forces that a program mixes with those of dynamics/.
///
/// Each acts at Gauss points of the faces and is pulled back to the control points, as Qin, Mandal and Vemuri 1998 (key
/// QMV98, 3.2) apply theirs. "Per area" is per area of the rest shape, as an elastic surface's mass is, but where a
/// force says otherwise. Lengths are in millimetres, and so are the body's.
#pragma once
#include <memory>
#include <optional>

#include "batten/dynamics/force.h"
#include "batten/mesh/mesh.h"
#include "batten/surface/quadrature.h"
#include "batten/volume/edge_search.h"
#include "batten/volume/spline_field.h"

namespace batten {

class SurfaceSamples;

/// Gauss points, and what each has of the rest shape's area.
struct AreaPlaces {
  std::shared_ptr<const SurfaceSamples> samples;  ///< with du and dv
  Scalars areas;
};

/// Throws what SurfaceSamples throws.
AreaPlaces area_places(const ElasticSurface& body, const QuadratureOptions& quadrature);

/// Options of PotentialForce.
struct PotentialOptions {
  double strength = 1.0;  ///< k, per area
  /// Without: the force is k grad P, the energy -k times the integral of P. With g, more than 0: the force is
  /// k grad P / sqrt(|grad P|^2 + g^2), which has no energy: the paper's (28), but that it fades where the gradient is
  /// not much more than g and its direction means nothing.
  std::optional<double> guard;
  QuadratureOptions quadrature{3, 1};
};

/// Draws the surface to where P is large: with the edge magnitude of a smoothed image (edge_magnitude()) to its edges,
/// from as far as the smoothing reaches. Taken at the end of a step: a step that is long for a strong force is
/// unstable.
class PotentialForce : public Force {
 public:
  /// Throws Error(BadArgument) for a guard that is not more than 0, NotFinite.
  PotentialForce(const ElasticSurface& body, std::shared_ptr<const SplineField> potential,
                 PotentialOptions options = {});

  std::string name() const override { return "image potential"; }
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  std::shared_ptr<const SplineField> potential_;
  PotentialOptions options_;
  AreaPlaces places_;
};

/// Options of EdgeSprings.
struct EdgeSpringOptions {
  double stiffness = 1.0;  ///< k, per area
  double reach = 3.0;      ///< how far edges are searched along the normal, mm
  QuadratureOptions quadrature{2, 0};
};

/// From each place a spring along the normal to the strongest edge that EdgeSearch finds there, with its weight w: the
/// force k w (edge - place), the energy 1/2 k w |edge - place|^2. Edges are found anew for each position of the
/// surface, and the force is minus the gradient of the energy with the edges held. Springs are implicit: stable for any
/// step.
class EdgeSprings : public Force {
 public:
  /// Throws Error(BadArgument) for a negative stiffness and a reach that is not more than 0, NotFinite.
  EdgeSprings(const ElasticSurface& body, std::shared_ptr<const EdgeSearch> edges, EdgeSpringOptions options = {});

  std::string name() const override { return "edge springs"; }
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  std::shared_ptr<const EdgeSearch> edges_;
  EdgeSpringOptions options_;
  AreaPlaces places_;
  std::shared_ptr<const PlaceRows> rows_;
};

/// Mean numbers of an image inside and outside of a part.
struct RegionMeans {
  double inside = 0.0;
  double outside = 0.0;
};

/// Of the voxels in a closed fine mesh, and of those in the box around it with `margin` voxels on each side, each with
/// the share of it that is inside or not. Throws Error(BadArgument) where nothing is inside or outside, and what
/// inside_volume() throws.
RegionMeans region_means(const Volume& image, const Mesh& fine, Index margin);

/// Options of RegionForce.
struct RegionOptions {
  double strength = 1.0;  ///< k, per area of the surface as it is
  QuadratureOptions quadrature{3, 1};
};

/// A pressure along the outward normal that is k where the image's number is the inside's mean, -k where it is the
/// outside's, and between them linear: k (2 I - inside - outside) / (inside - outside), k or -k at most. It lets the
/// surface grow over what looks like the inside, and is minus the gradient of Chan and Vese's energy of regions (2001,
/// key CV01) as far as that is linear. No energy is told.
class RegionForce : public Force {
 public:
  /// Throws Error(BadArgument) for equal means, NotFinite.
  RegionForce(const ElasticSurface& body, std::shared_ptr<const SplineField> image, RegionMeans means,
              RegionOptions options = {});

  std::string name() const override { return "region"; }
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  std::shared_ptr<const SplineField> image_;
  RegionMeans means_;
  RegionOptions options_;
  std::shared_ptr<const SurfaceSamples> samples_;
};

/// The distance from each voxel of a mask's box (label_mask()) to the mask's border, mm: negative inside. Exact to half
/// a voxel. The axes must be at right angles. Throws what distance_transform() throws; BadArgument for a mask without
/// voxels inside or outside.
Volume signed_distance(const Volume& mask);

/// Options of MaskSprings.
struct MaskSpringOptions {
  double stiffness = 1.0;  ///< k, per area
  QuadratureOptions quadrature{2, 0};
};

/// Springs to the border of a mask: with the distance d, the energy 1/2 k d^2, and the force -k d grad d, its gradient.
/// Implicit along grad d: stable for any step.
class MaskSprings : public Force {
 public:
  /// distance: of signed_distance(). Throws Error(BadArgument) for a negative stiffness, NotFinite.
  MaskSprings(const ElasticSurface& body, std::shared_ptr<const SplineField> distance, MaskSpringOptions options = {});

  std::string name() const override { return "mask springs"; }
  void add(const ForceInput& input, ForceSum& sum) const override;
  std::shared_ptr<const Force> refined(const ElasticSurface& body, const ElasticSurface& child) const override;

 private:
  std::shared_ptr<const SplineField> distance_;
  MaskSpringOptions options_;
  AreaPlaces places_;
  std::shared_ptr<const PlaceRows> rows_;
};

}  // namespace batten
