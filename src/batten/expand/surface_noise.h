/// \file Noise on a subdivision surface (key LC06, section 5; docs/mathematics.md, Errata).
///
/// Each octave takes random numbers at the vertices of one level of refinement and interpolates them: control values
/// whose limit passes through the numbers. Those are refined on to the finest level and added there, so the noise is as
/// smooth as the surface, follows its creases and boundaries, and costs time linear in the finest mesh.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// A sum of octaves: octave i has 2^i times the frequency of the first, and gain^i times its amplitude.
struct NoiseOptions {
  std::uint64_t seed = 1;
  double frequency = 4.0;  ///< of the first octave: features along the diagonal of the surface's bounding box
  int octaves = 4;
  double gain = 0.5;                                  ///< in [0, 4]; the more, the rougher
  Eigen::Vector3d stretch = Eigen::Vector3d::Ones();  ///< features are so many times as long along x, y and z
};

/// Built for a connectivity and a number of refinements; gives any number of noises at once. Memory: the topologies of
/// all levels, 4/3 of the finest.
///
/// The random number of an octave at a vertex is solid_noise() at its place on the surface. It is sampled at the
/// coarsest level whose edges are short enough for the octave's features, else at the finest: there, features are as
/// large as its edges. So the same noise comes out, but for what a mesh cannot hold, however the surface is meshed.
class SurfaceNoise {
 public:
  /// Throws Error(NotTriangles, BadArgument, TooLarge, Cancelled).
  SurfaceNoise(const Topology& topology, const Scheme& scheme, int levels, const Progress& progress = {});

  /// Of the finest level.
  Index vertex_count() const { return level(levels()).vertex_count(); }
  int levels() const { return static_cast<int>(refined_.size()); }
  /// Level 0 is the mesh given.
  const Topology& level(int number) const {
    return number == 0 ? topology_ : refined_[static_cast<std::size_t>(number) - 1];
  }

  /// One column a noise, of mean 0 and standard deviation 1 (over the seeds, where the mesh is fine enough), at the
  /// vertices of the finest level. points: their places, one row of three each, for example limit positions; they only
  /// say what lies where.
  /// Throws Error: BadShape, NotFinite, BadArgument (options out of range), Cancelled.
  Values values(ConstValuesRef points, std::span<const NoiseOptions> noises, const Progress& progress = {}) const;

 private:
  Values refined_once(int from, const Scheme& scheme, const std::vector<double>& vertex_alpha, ConstValuesRef control,
                      const Progress& progress) const;

  Topology topology_;
  Scheme scheme_;
  std::vector<Topology> refined_;
};

}  // namespace batten
