/// \file Noise on a subdivision surface (key LC06, section 5).
///
/// Each octave takes random numbers at the vertices of one level of refinement and interpolates them: its control
/// values have a limit surface through these numbers. They are refined to the finest level and added there. The noise
/// is therefore as smooth as the surface and follows its creases and boundaries. The cost is linear in the finest mesh.
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
  /// Of the first octave: the number of features along the diagonal of the surface's bounding box.
  double frequency = 4.0;
  int octaves = 4;
  double gain = 0.5;                                  ///< in [0, 4]; larger is rougher
  Eigen::Vector3d stretch = Eigen::Vector3d::Ones();  ///< the relative length of features along x, y and z
};

/// Built for a connectivity and a number of refinements; it then computes any number of noises at once. Memory: the
/// topologies of all levels, 4/3 of the finest.
///
/// The random number of an octave at a vertex is solid_noise() at its place on the surface. An octave is sampled at the
/// coarsest level whose edges are short enough for its features, or else at the finest level, where features are as
/// large as the edges. The same noise therefore results for different meshes of a surface, except for features that a
/// mesh is too coarse for.
class SurfaceNoise {
 public:
  /// Throws Error(NotTriangles, BadArgument, TooLarge, Cancelled).
  SurfaceNoise(const Topology& topology, const Scheme& scheme, int levels, const Progress& progress = {});

  /// The number of vertices of the finest level.
  Index vertex_count() const { return level(levels()).vertex_count(); }
  int levels() const { return static_cast<int>(refined_.size()); }
  /// Level 0 is the given mesh.
  const Topology& level(int number) const {
    return number == 0 ? topology_ : refined_[static_cast<std::size_t>(number) - 1];
  }

  /// One column for each noise at the vertices of the finest level, with mean 0 and standard deviation 1 (over the
  /// seeds, where the mesh is fine enough). points: one row of three for each of these vertices, for example limit
  /// positions; they only place the noise.
  /// Throws Error: BadShape, NotFinite, BadArgument (options out of range), Cancelled.
  Values values(ConstValuesRef points, std::span<const NoiseOptions> noises, const Progress& progress = {}) const;

 private:
  Values refined_once(int from, const Scheme& scheme, ConstValuesRef control, const Progress& progress) const;

  Topology topology_;
  Scheme scheme_;
  std::vector<Topology> refined_;
};

}  // namespace batten
