/// \file A picture of a mesh: Embree rays, soft shadows, four samples a pixel, a default view that shows the shape.
///
/// The shape stands on a ground that shows nothing but its shadow. Light: a broad key from the upper left, a sky dome,
/// a weak fill; one shadow ray and one sky ray a sample, in a pattern spread over 8x8 pixels so that a small filter,
/// which stops at edges, sums them into 256 (samples = 2) of each. Fixed patterns: the same picture for any number of
/// threads.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/render/color_scale.h"
#include "batten/render/picture.h"

namespace batten {

/// What the picture shows. `surface` is drawn as it stands (refine it first); the rest is drawn with it where present.
/// Any of them may be empty, not all. Markers and lines cast no shadow.
struct Scene {
  Mesh surface;  ///< polygons; more than three corners: drawn as fans. Holes are not drawn
  /// V-by-3 shading normals, or one row for each entry of surface.face_vertices, or empty: from the faces, split where
  /// they meet at about 40 degrees or more. Either sign; zero: the facet's own.
  Values normals;
  Values colors;    ///< V-by-3 linear colours, or empty: surface_color
  Scalars scalars;  ///< V numbers to be drawn in `scale`'s colours (NaN: grey), or empty
  ColorScale scale;
  Points markers = Points(0, 3);  ///< drawn as small spheres (the targets)
  Scalars marker_scalars;         ///< one number a marker, to be drawn likewise, or empty: marker_color
  Mesh lines;                     ///< its edges are drawn as thin tubes (the control mesh)
  Color surface_color{0.60F, 0.335F, 0.140F};
  Color back_color{0.27F, 0.31F, 0.35F};  ///< of the faces' back sides
  Color marker_color{0.018F, 0.040F, 0.115F};
  Color line_color{0.030F, 0.075F, 0.190F};
};

/// Which way is up. Auto: z, but y where the shape stands better on its lowest y than on its lowest z (the hull of what
/// is near the bottom, as a share of the floor plan, if the centre of mass is above it), or stands on neither.
enum class UpAxis { Auto, Y, Z };

/// What the shape stands on.
enum class Ground { Shadow, None };

/// From where. Auto: from the front (-y with z up, +z with y up), turned to the right by 25 to 60 degrees, the more the
/// deeper the shape, and raised by 20 to 40, the more the flatter. Iso: from the front, the right and above alike.
/// Left: the eye stands at the shape's -x.
enum class View { Auto, Front, Back, Left, Right, Top, Bottom, Iso };

/// How the surface is shaded. Zebra: by what it would mirror of a surrounding of light and dark bands. They break where
/// the surface has an edge, kink where its curvature jumps, and flow where it is fair. Colours are not drawn.
enum class Shading { Plain, Zebra };

/// Where the eye stands: at target + distance * direction. In the mesh's axes and unit.
struct Viewpoint {
  std::array<double, 3> target;     ///< what is in the middle of the picture
  std::array<double, 3> direction;  ///< towards the eye, of length 1
  double distance;
  UpAxis up;  ///< Y or Z
};

/// How to draw a scene.
struct RenderOptions {
  int width = 1600;
  int height = 1200;
  int samples = 2;  ///< per axis: 2 means 2x2 a pixel
  UpAxis up = UpAxis::Auto;
  View view = View::Auto;
  std::optional<std::array<double, 3>> direction;  ///< from the centre to the eye, in the mesh's axes; overrules view
  std::optional<Viewpoint> viewpoint;              ///< overrules up, view and direction, and nothing is fitted
  Shading shading = Shading::Plain;
  PictureStyle style;
  Ground ground = Ground::Shadow;
  /// In the mesh's unit. 0: for n markers or lines, 14 % (lines 4 %) of the mean distance between n points spread over
  /// the shape, at most 0.5 % (0.12 %) of its diagonal; more than 20 000 markers or 60 000 lines are not drawn.
  double marker_radius = 0.0;
  double line_radius = 0.0;
};

/// From where all these scenes fit into 85 % of the picture. Throws what render throws.
Viewpoint fit_viewpoint(const std::vector<const Scene*>& scenes, const RenderOptions& options = {});

/// Once around the scenes in `count` equal steps, at one distance from the middle of their bounding box; the first as
/// options ask. Throws what render throws, and Error(BadArgument) for a count below 1 or a view from straight above or
/// below.
std::vector<Viewpoint> turntable(const std::vector<const Scene*>& scenes, const RenderOptions& options, int count);

/// The eye sees 30 degrees in height; the shape is fitted into 85 % of the frame. With style.transparent the shadow is
/// black of that opacity which darkens the style's background as much.
/// Cost: 1 M triangles at 1600x1200 in 3 s on two cores; memory: 110 bytes a pixel and 200 a triangle.
/// Throws Error: BadArgument (nothing to draw; sizes, samples or radii out of range), BadShape, IndexOutOfRange,
/// NotFinite, Cancelled.
Picture render(const Scene& scene, const RenderOptions& options = {}, const Progress& progress = {});

}  // namespace batten
