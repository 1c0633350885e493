/// \file A picture of a mesh: Embree rays, soft shadows, four samples a pixel, a default view that shows the shape.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "batten/mesh/mesh.h"

namespace batten {

using Color = std::array<float, 3>;  ///< linear, in [0, 1]

/// What the picture shows. `surface` is drawn as it stands (refine it first); the rest is drawn with it where present.
struct Scene {
  Mesh surface;                      ///< polygons; faces of more than three corners are drawn as fans
  Values normals;                    ///< V-by-3 shading normals, or empty: computed from the faces, split at creases' angles
  Values colors;                     ///< V-by-3 linear colours, or empty: surface_color
  Points markers = Points(0, 3);     ///< drawn as small spheres (the targets)
  Mesh lines;                        ///< its edges are drawn as thin tubes (the control mesh)
  Color surface_color{0.80F, 0.62F, 0.38F};
};

struct RenderOptions {
  int width = 1600;
  int height = 1200;
  int samples = 2;                   ///< per axis: 2 means 2x2 a pixel
  std::optional<std::array<double, 3>> view;  ///< direction from the centre to the eye; z is up; absent: chosen by the shape
  Color background{0.96F, 0.96F, 0.95F};
  double marker_radius = 0.0;        ///< in the mesh's unit; 0: chosen from the number of markers and the size
  double line_radius = 0.0;          ///< likewise
};

/// 8-bit sRGB rows from the top, 3 bytes a pixel.
struct Picture {
  int width = 0;
  int height = 0;
  Buffer<unsigned char> pixels;
};

/// Cost: 1 M triangles at 1600x1200 in 3 s on two cores. Throws Error(BadArgument, BadShape, NotFinite).
Picture render(const Scene& scene, const RenderOptions& options = {}, const Progress& progress = {});

/// Writes an 8-bit RGB PNG through a temporary name. Throws Error(FileNotWritable).
void write_png(const std::string& path, const Picture& picture);

}  // namespace batten
