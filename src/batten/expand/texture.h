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

/// Colours as a function of place and noise: ramp.color(pattern(place, noises)).
struct Texture {
  std::vector<NoiseOptions> noises;  ///< the first one is the texture's own, the rest its details
  /// The position on the ramp. `place` is in features of the first noise (diagonals times its frequency) from the
  /// middle of the surface's bounding box, x along its longest side and z along its shortest; so are the stretches of
  /// the noises. `noise` has one number for each of `noises`.
  std::function<double(const Eigen::Vector3d& place, const double* noise)> pattern;
  ColorRamp ramp;
};

/// What a preset's first noise is to be instead; negative or 0: the preset's own.
struct PresetOptions {
  std::uint64_t seed = 1;
  double frequency = 0.0;  ///< the other noises and the pattern are scaled with it
  int octaves = 0;
  double gain = -1.0;
};

/// Throws Error(BadArgument) for options out of range.
Texture preset_texture(TexturePreset preset, const PresetOptions& options = {});

/// Noise as it is, from two standard deviations below zero to two above.
Texture plain_texture(const NoiseOptions& noise, const ColorRamp& ramp);

/// Which surface is coloured, and how.
struct TextureOptions {
  int levels = 3;  ///< of refinement; colours are as fine as the vertices
  /// Colours the mesh as it is instead of its limit surface: nothing is refined or moved.
  bool flat = false;
  /// Moves each vertex along its normal by so much times the first noise, in the mesh's unit.
  double displacement = 0.0;
};

/// The limit surface as surface_mesh() gives it, or with options.flat the mesh, with the vertex attribute "color" (sRGB
/// in [0, 1]). Where it is displaced, "normal" is left out. Time O(V) of the result: about a microsecond a vertex.
/// Throws what surface_mesh and SurfaceNoise throw.
Mesh textured_surface(const Topology& topology, const Scheme& scheme, const Mesh& control, const Texture& texture,
                      const TextureOptions& options = {}, const Progress& progress = {});

}  // namespace batten
