/// \file What lies around a place of a body at rest, with weights that fall smoothly to 0.
#pragma once
#include <span>
#include <vector>

#include "batten/dynamics/surface_samples.h"
#include "batten/surface/limit_surface.h"

namespace batten {

/// Const and safe from several threads. Distances are straight ones in the rest shape.
class SpreadPlaces {
 public:
  struct Share {
    std::ptrdiff_t sample;
    double weight;
  };

  SpreadPlaces(const ElasticSurface& body, double radius, const QuadratureOptions& quadrature);

  const SurfaceSamples& samples() const { return samples_; }

  /// For each place the samples at distances x radius, x < 1, whose normals turn from its own by less than a right
  /// angle. Their weights, (1 - x^2)^3 times the area, sum to 1. Threaded; O(faces) a place.
  std::vector<std::vector<Share>> around(std::span<const SurfacePlace> places) const;

 private:
  std::vector<Share> around(const SurfacePlace& place) const;

  double radius_;
  SurfaceSamples samples_;
  LimitSurface surface_;
  Points jets_;  ///< of the samples
  Scalars areas_;
  Points centers_;  ///< of a ball around each element's samples
  Scalars radii_;
};

}  // namespace batten
