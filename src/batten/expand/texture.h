/// \file Surfaces coloured by noise: marble, wood and the like (key LC06, section 5).
#pragma once
#include <functional>
#include <vector>

#include "batten/expand/color_ramp.h"
#include "batten/expand/surface_noise.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// Textures that come with Batten.
enum class TexturePreset { Marble, Wood, Granite, Rust, Clouds };

/// A texture maps places and noise to colours: ramp.color(pattern(place, noises)).
struct Texture {
  std::vector<NoiseOptions> noises;  ///< the first one is the texture's main noise, the others add detail
  /// Returns the position on the ramp. `place` is relative to the middle of the surface's bounding box, in features of
  /// the first noise (diagonals times its frequency), x along its longest side and z along its shortest. The noises'
  /// stretches refer to the same axes. `noise` has one number for each of `noises`.
  std::function<double(const Eigen::Vector3d& place, const double* noise)> pattern;
  ColorRamp ramp;
};

/// Changes of a preset's first noise. Negative numbers and 0 keep the preset's own.
struct PresetOptions {
  std::uint64_t seed = 1;
  double frequency = 0.0;  ///< the other noises and the pattern are scaled with it
  int octaves = 0;
  double gain = -1.0;
};

/// Throws Error(BadArgument) for options out of range.
Texture preset_texture(TexturePreset preset, const PresetOptions& options = {});

/// A texture of plain noise, from two standard deviations below zero to two above.
Texture plain_texture(const NoiseOptions& noise, const ColorRamp& ramp);

/// Which surface is coloured, and how.
struct TextureOptions {
  int levels = 3;  ///< levels of refinement; each vertex has a colour
  /// Colours the mesh itself instead of its limit surface, without refining or moving it.
  bool flat = false;
  /// Moves each vertex along its normal by this length, in the mesh's unit, times the first noise.
  double displacement = 0.0;
};

/// The limit surface as surface_mesh() makes it (with options.flat, the mesh) with the vertex attribute "color" (sRGB
/// in [0, 1]). If it is displaced, "normal" is left out. O(V) of the result, about a microsecond for each vertex.
/// Throws what surface_mesh and SurfaceNoise throw.
Mesh textured_surface(const Topology& topology, const Scheme& scheme, const Mesh& control, const Texture& texture,
                      const TextureOptions& options = {}, const Progress& progress = {});

}  // namespace batten
