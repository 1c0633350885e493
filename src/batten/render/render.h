/// \file A picture of a mesh: Embree rays, soft shadows, four samples for each pixel, a default view that shows the
/// shape.
///
/// The shape stands on a ground that is visible only by its shadow. The light is a broad key light from the upper left,
/// a sky dome and a weak fill light. Each sample has one shadow ray and one sky ray, in a pattern over 8x8 pixels, so
/// that a small filter, which stops at edges, averages 256 of each (samples = 2). The patterns are fixed: the picture
/// does not depend on the number of threads.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/mesh/up_axis.h"
#include "batten/render/color_scale.h"
#include "batten/render/picture.h"

namespace batten {

/// The content of a picture. `surface` is drawn as it is (refine it first), the rest is drawn with it. Each part may be
/// empty, but not all. Markers and lines have flat colours and cast no shadow; the parts of lines behind the surface
/// are faint. Given colours come out as they are where the light is ordinary: the median over the picture is exact, and
/// half of each colour does not depend on the light. `scalars` are drawn in the bar's colours, at most a tenth darker.
struct Scene {
  Mesh surface;  ///< polygons; those of more than three corners are drawn as fans. Holes are not drawn
  /// V-by-3 shading normals, or one row for each entry of surface.face_vertices. Empty: computed from the faces and
  /// split where they meet at about 40 degrees or more. Their sign does not matter; the facet's normal replaces zeros.
  Values normals;
  Values colors;    ///< V-by-3 linear colours, or empty for surface_color
  Scalars scalars;  ///< V numbers drawn in `scale`'s colours (NaN: grey), or empty
  ColorScale scale;
  Points markers = Points(0, 3);  ///< drawn as dots, for example the targets
  Scalars marker_scalars;         ///< a number for each marker, drawn likewise, or empty for marker_color
  Mesh lines;  ///< its edges are drawn as thin lines, for example the control mesh; faces may have two corners
  Scalars line_scalars;  ///< a number for each face of `lines`, drawn in `scale`'s colours (NaN: line_color), or empty
  Color surface_color{0.60F, 0.335F, 0.140F};
  Color back_color{0.27F, 0.31F, 0.35F};  ///< of the back sides of faces
  Color marker_color{0.018F, 0.040F, 0.115F};
  Color line_color{0.030F, 0.075F, 0.190F};
};

/// The ground below the shape.
enum class Ground { Shadow, None };

/// The direction of the view. Auto: from the front of up_frame (-y with z up, +z with y up), turned to the right by 25
/// to 40 degrees (more for deeper shapes) and raised by 20 to 40 (more for flatter ones); a flat mesh is seen along its
/// normal. Iso: equally from the front, the right and above. Left: from the shape's -x with y or z up.
enum class View { Auto, Front, Back, Left, Right, Top, Bottom, Iso };

/// The shading of the surface. Zebra shows the reflection of light and dark bands. The bands break at edges, have kinks
/// where the curvature jumps, and flow where the surface is fair. Colours are not drawn.
enum class Shading { Plain, Zebra };

/// The eye's position, target + distance * direction, in the mesh's axes and unit.
struct Viewpoint {
  std::array<double, 3> target;     ///< the middle of the picture
  std::array<double, 3> direction;  ///< from the target to the eye, of length 1
  double distance;
  UpAxis up;  ///< not Auto
};

/// Options of render.
struct RenderOptions {
  int width = 1600;
  int height = 1200;
  int samples = 2;           ///< for each axis of a pixel: 2 means 2x2
  UpAxis up = UpAxis::Auto;  ///< guess_up_axis of the first scene
  View view = View::Auto;
  std::optional<std::array<double, 3>> direction;  ///< from the centre to the eye, in the mesh's axes; overrides view
  std::optional<Viewpoint> viewpoint;              ///< overrides up, view and direction; nothing is fitted
  Shading shading = Shading::Plain;
  PictureStyle style;
  Ground ground = Ground::Shadow;
  /// In the mesh's unit, and drawn whatever they cover. 0: by the picture's size, so that a line is 1/550 of its
  /// shorter side wide and a dot 1/125, or twice that where they have numbers, and thinner, down to a pixel, if they
  /// would cover more than a fifth of the surface. Those without numbers that still would are not drawn.
  double marker_radius = 0.0;
  double line_radius = 0.0;
};

/// A viewpoint from which all these scenes fit into 85 % of the picture. Throws what render throws.
Viewpoint fit_viewpoint(const std::vector<const Scene*>& scenes, const RenderOptions& options = {});

/// Viewpoints around the scenes in `count` equal steps, at the same distance from the middle of their bounding box,
/// starting with the view of the options. Throws what render throws, and Error(BadArgument) for a count below 1 or a
/// view from straight above or below.
std::vector<Viewpoint> turntable(const std::vector<const Scene*>& scenes, const RenderOptions& options, int count);

/// The style, or with a grey background where more than 5 % of the scene's colours can hardly be told from the style's.
PictureStyle style_beside(const Scene& scene, PictureStyle style);

/// Draws a scene. The field of view is 30 degrees in height, and the shape is fitted into 85 % of the frame. With
/// style.transparent the shadow is black, with the opacity that darkens the style's background equally.
/// Cost: 1 M triangles at 1600x1200 in 3 s on two cores; memory: 130 bytes for each pixel and 200 for each triangle.
/// Throws Error: BadArgument (nothing to draw; sizes, samples or radii out of range), BadShape, IndexOutOfRange,
/// NotFinite, Cancelled.
/// notes: null, or gets a sentence for each kind of markers or lines that is not drawn.
Picture render(const Scene& scene, const RenderOptions& options = {}, const Progress& progress = {},
               std::vector<std::string>* notes = nullptr);

}  // namespace batten
