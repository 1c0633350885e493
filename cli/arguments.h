/// \file The command line's options of each verb, as plain data.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "batten/adaptive/adaptive.h"
#include "batten/energy/shape_energy_kind.h"
#include "batten/expand/denoise.h"
#include "batten/expand/morph.h"
#include "batten/expand/sharpen.h"
#include "batten/expand/texture.h"
#include "batten/interpolate/attributes.h"
#include "batten/interpolate/interpolator.h"
#include "batten/mesh/repair.h"
#include "batten/render/render.h"

namespace batten::cli {

/// The options that mean the same in every verb.
struct CommonArguments {
  std::string input;
  std::string output;
  std::string input_format;  ///< for stdin, or to overrule the extension
  std::string output_format;
  std::string report;
  std::optional<SchemeKind> scheme;
  std::optional<BoundaryRule> boundary;
  std::optional<CreaseMethod> crease_method;
  std::optional<TriangleRule> triangle_rule;
  std::optional<FaceVaryingRule> face_varying;
  std::optional<AttributeRule> attributes;  ///< not given: scheme, or for interpolate interpolated
  double alpha = 0.0;
  std::optional<double> tension;
  std::optional<ButterflyBoundary> butterfly_boundary;
  UpAxis up = UpAxis::Auto;
  bool triangulate = false;
  bool repair = false;
  bool quiet = false;
  bool ascii = false;
  std::optional<double> features;  ///< find sharp edges of so many degrees
  bool text_to_stderr = false;     ///< an output takes standard output
  int threads = 0;
};

/// What the surface's colours show.
enum class Coloring {
  None,
  Error,      ///< distance from the limit position of each vertex to its target
  Moved,      ///< distance from each control point to the limit position of its vertex
  Mean,       ///< mean curvature of the limit surface
  Gaussian,   ///< Gaussian curvature of the limit surface
  Valence,    ///< edges at each vertex; at a boundary twice the faces, so that regular is the same
  Sharpness,  ///< of creases and corners
  Normals,    ///< angle between each limit normal and the one wanted
  Zebra,      ///< bands that the surface mirrors
  Checker     ///< squares of the texture coordinates
};

/// The same for every verb that draws.
struct PictureArguments {
  std::string path;  ///< empty: none
  int width = 1600;
  int height = 0;  ///< 0: three quarters of the width, with two panels three eighths
  int samples = 2;
  View view = View::Auto;
  std::optional<std::array<double, 3>> direction;
  Coloring coloring = Coloring::None;
  std::optional<std::array<double, 2>> range;  ///< of the colour bar, instead of a fitted one
  bool transparent = false;
  bool before_after = false;
  int turntable = 0;  ///< pictures around; 0: one picture
};

/// The words of --normals that name no file.
inline constexpr const char* kNormalsOfMesh = "mesh";
inline constexpr const char* kNormalsEstimated = "estimate";

/// Normals that the surface shall have.
struct NormalArguments {
  std::string source;      ///< empty: none; kNormalsOfMesh, kNormalsEstimated or a mesh file
  double tolerance = 0.0;  ///< in degrees
  bool relax = true;       ///< soften the ripples
};

/// A length in the mesh's unit, or as a share of the bounding box's diagonal.
struct Length {
  double value = 0.0;
  bool relative = false;
};

/// The fairest surface through the points instead of the one of the mesh's own connectivity.
struct FairArguments {
  bool fair = false;
  std::optional<int> levels;
  ShapeEnergyKind energy = ShapeEnergyKind::Variation;
  std::optional<Length> smoothing;
};

struct InterpolateArguments {
  CommonArguments common;
  PictureArguments picture;
  NormalArguments normals;
  FairArguments fair;
  InterpolateOptions options;
  std::string plot;  ///< residual against iteration
  bool compare_methods = false;
  int levels = -1;           ///< -1: write the control mesh, or for GLB at most 3
  std::string from;          ///< a control mesh whose surface shall follow the points; empty: solve for all points
  std::optional<int> rings;  ///< of a moved point, where control points may move; with `from`
};

struct SubdivideArguments {
  CommonArguments common;
  PictureArguments picture;
  int levels = -1;  ///< -1: once, or for adaptive tessellation as often as a bound asks
  bool limit = false;
  bool compare = false;         ///< schemes, instead of writing a mesh
  std::optional<Length> chord;  ///< one of these three: adaptive tessellation
  std::optional<Length> edge_length;
  std::optional<double> angle;
  std::optional<FaceKind> faces;
  std::optional<Index> max_faces;

  bool adaptive() const { return chord || edge_length || angle; }
};

struct RenderArguments {
  CommonArguments common;
  PictureArguments picture;
  std::string targets;   ///< mesh whose vertices the surface should pass through, for Coloring::Error
  std::string values;    ///< mesh file with numbers at the vertices, instead of a Coloring
  std::string value;     ///< which of them; empty: the only one
  int levels = -1;       ///< -1: as many as make the picture smooth
  bool flat = false;     ///< draw the mesh itself, not its subdivision surface
  bool control = false;  ///< draw the control mesh as lines
  bool points = false;   ///< draw the vertices' limit positions as small spheres
};

struct DistanceArguments {
  CommonArguments common;  ///< input: the surface
  PictureArguments picture;
  std::string scan;
};

/// The presets' names, in the order of the gallery.
inline constexpr std::pair<TexturePreset, const char*> kTexturePresets[] = {{TexturePreset::Marble, "marble"},
                                                                            {TexturePreset::Wood, "wood"},
                                                                            {TexturePreset::Granite, "granite"},
                                                                            {TexturePreset::Rust, "rust"},
                                                                            {TexturePreset::Clouds, "clouds"}};

struct TextureArguments {
  CommonArguments common;
  PictureArguments picture;
  std::optional<TexturePreset> preset;  ///< none: plain noise
  PresetOptions noise;
  std::vector<std::array<double, 3>> colors;  ///< of the ramp, instead of the preset's
  int levels = -1;                            ///< -1: as many as make the colours fine
  bool flat = false;
  std::optional<Length> displace;
  std::string gallery;  ///< picture of all presets
};

struct DenoiseArguments {
  CommonArguments common;
  PictureArguments picture;
  DenoiseOptions options;
  std::optional<double> strength;  ///< in edge lengths, instead of passes
};

struct SharpenArguments {
  CommonArguments common;
  PictureArguments picture;
  SharpenOptions options;
};

struct BandsArguments {
  CommonArguments common;
  PictureArguments picture;
  SeriesMatrix matrix = SeriesMatrix::Limit;
  int count = 6;
  std::vector<double> gains;  ///< one a band, finest first; empty: all 1
  bool keep_boundary = false;
  bool displacements = false;  ///< every band as an attribute of the output
  std::string plot;
};

/// The files of a morph where --frames does not say how many.
inline constexpr int kMorphFrames = 11;

struct MorphArguments {
  CommonArguments common;  ///< input: where it starts
  PictureArguments picture;
  std::string target;  ///< where it ends
  MorphOptions options;
  std::optional<double> rho;  ///< the paper's sequence
  bool align = true;
  int frames = -1;           ///< -1: kMorphFrames files, or 24 key frames in a GLB
  std::optional<double> at;  ///< one frame
  double seconds = 2.0;      ///< of a GLB's animation
  int levels = -1;           ///< of a GLB's surface; -1: at most 3
  bool resample = false;
};

/// What the colours of a medial surface show.
enum class MedialColoring { Angle, Distance, Shift, Radius };

struct MedialArguments {
  CommonArguments common;  ///< input: the medial model
  PictureArguments picture;
  int levels = -1;  ///< -1: write the control mesh, or for GLB at most 3
  std::optional<MedialColoring> coloring;
  bool normals = false;           ///< turned to the spokes
  double normal_tolerance = 0.0;  ///< in degrees
  std::string sheet;              ///< mesh of the medial sheet
  std::string model;              ///< the model again
  int sheet_levels = 0;           ///< of these two
};

struct InfoArguments {
  CommonArguments common;
  bool curvature = false;
  bool self_intersections = false;  ///< also in a large mesh
};

struct RepairArguments {
  CommonArguments common;
  RepairOptions options;
};

int run_info(const InfoArguments& arguments);
int run_interpolate(const InterpolateArguments& arguments);
/// interpolate --fair.
int run_fair(const InterpolateArguments& arguments);
int run_subdivide(const SubdivideArguments& arguments);
/// subdivide where a bound is given.
int run_adaptive(const SubdivideArguments& arguments);
/// subdivide --compare.
int run_compare_schemes(const SubdivideArguments& arguments);
int run_convert(const CommonArguments& arguments);
int run_repair(const RepairArguments& arguments);
int run_render(const RenderArguments& arguments);
int run_morph(const MorphArguments& arguments);
int run_texture(const TextureArguments& arguments);
int run_distance(const DistanceArguments& arguments);
int run_denoise(const DenoiseArguments& arguments);
int run_sharpen(const SharpenArguments& arguments);
int run_bands(const BandsArguments& arguments);
int run_medial(const MedialArguments& arguments);

}  // namespace batten::cli
