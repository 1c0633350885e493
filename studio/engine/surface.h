/// \file The surface that the page shows: solved for, drawn, dragged, measured, asked.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "batten/interpolate/fair_interpolation.h"
#include "batten/interpolate/interpolated_mesh.h"
#include "batten/interpolate/interpolation_updates.h"
#include "batten/nearest/nearest_point.h"
#include "batten/tessellate/tessellator.h"
#include "studio/engine/adaptive_drawing.h"
#include "studio/engine/elastic.h"
#include "studio/engine/mesh_file.h"

namespace batten::studio {

/// How the page wants its surface.
struct SurfaceWishes {
  Scheme scheme;
  bool interpolated = true;  ///< passes through the points; otherwise they are its control points
  bool fair = false;         ///< the fairest of those (interpolate/fair_interpolation.h)
  double smoothing = 0.0;    ///< FairOptions::smoothing
  int levels = 0;            ///< of the mesh that is drawn; 0: as suits the screen
  double chord = 0.0;        ///< instead: how far what is drawn may be from the surface; 0: any
  Values normals = {};       ///< wanted ones (interpolate/wanted_normals.h), or no rows; for interpolated surfaces
};

/// One surface of a mesh file. Values at vertices follow Tessellator's order.
class Surface {
 public:
  /// Throws what solving throws.
  Surface(std::shared_ptr<const MeshFile> file, const SurfaceWishes& wishes, const Progress& progress);

  /// {vertices, faces, diagonal, maxError, worstVertex, method, iterations, residuals, refined, moved, note}. After
  /// drawing() under a tolerance also {triangles, unmet}.
  val report() const;
  /// {points, normals, triangles, control, edges, sharpness}: floats; edges as pairs of control vertices.
  val drawing();
  /// {points, normals, control} where the connectivity is that of the last drawing(); under a tolerance its triangles
  /// are other ones, and are given too. room: the arrays of an earlier shape, which are filled again where they have
  /// the sizes, or null.
  val shape(const val& room);
  /// What moves changed since the last shape(), drawing() or change(): {vertices, points, normals, moved, control},
  /// where `points` and `normals` are those of the drawn `vertices` and `control` are the control points `moved`; or
  /// shape(room), where much changed.
  val change(const val& room);
  /// Moves point `vertex`; the surface follows. {moved, local, maxError}.
  val move(int vertex, double x, double y, double z, int rings);
  /// Takes the control points that an elastic body of the same connectivity has now.
  val follow(const Elastic& body);
  /// Where the surface is at the vertices of the file's mesh.
  val limit_points() const;
  /// A number for each vertex drawn: {numbers, positions (0 to 1 on the bar, -1: none), scale}. word: error, moved,
  /// mean, gaussian, valence, sharpness.
  val field(const std::string& word);
  /// A colour for each vertex drawn, sRGB in [0, 1]. preset: TexturePreset.
  val texture(int preset, int seed);
  /// The place nearest to a point: {face, u, v, point, normal, mean, gaussian, greatest, least}.
  val probe(double x, double y, double z);
  /// Distances of points from the surface, as field().
  val distances(const val& points);
  /// The control mesh with all that hangs on the file's mesh, as the tool writes it: a MeshFile.
  val control_file() const;

  const Topology& topology() const { return topology_; }
  const Scheme& scheme() const { return scheme_; }
  const Values& control() const { return control_; }

 private:
  void solve(const Progress& progress);
  void solve_fairly(const Progress& progress);
  void take(const InterpolationUpdates& updates);
  void prepare();
  Mesh control_mesh() const;
  /// The Butterflies have no closed form that a distance could be measured from.
  bool is_adaptive() const { return wishes_.chord > 0.0 && !is_interpolating(scheme_.kind); }
  bool has_normals() const { return wishes_.interpolated && wishes_.normals.rows() > 0; }
  FairOptions fair_options() const;

  std::shared_ptr<const MeshFile> file_;
  SurfaceWishes wishes_;
  Topology given_;  ///< of the file's mesh
  Points targets_;
  Topology topology_;
  Scheme scheme_;
  Values control_;
  std::optional<Interpolator> interpolator_;
  std::optional<InterpolationUpdates> updates_;
  std::optional<InterpolationReport> solved_;
  std::optional<double> worst_angle_;  ///< between normals wanted and reached, in radians
  std::string note_;
  int levels_ = 1;
  std::optional<Tessellator> tessellator_;   ///< where there is no tolerance
  std::optional<AdaptiveDrawing> adaptive_;  ///< where there is one
  std::optional<SurfacePatches> patches_;
  std::optional<LimitSurface> limit_;
  std::optional<NearestPoints> nearest_;
  bool is_current_ = false;                  ///< limit_ and nearest_ are those of control_
  std::optional<std::vector<Index>> moved_;  ///< control vertices that points_ do not follow yet; nothing: all
  std::vector<float> points_;
  std::vector<float> normals_;
};

/// wishes: {scheme, boundary, alpha, interpolate, fair, smoothing, levels, chord, normals}; normals: four numbers each,
/// a vertex and the direction wanted there.
val make_surface(const std::shared_ptr<MeshFile>& file, const val& wishes, const val& report);

}  // namespace batten::studio
