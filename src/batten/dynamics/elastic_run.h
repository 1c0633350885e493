/// \file A scene in time: its body, forces and supports, step by step.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batten/dynamics/elastic_motion.h"
#include "batten/dynamics/scene.h"
#include "batten/mesh/mesh.h"
#include "batten/progress.h"

namespace batten {

/// The files that a scene names.
struct SceneMeshes {
  Mesh rest;
  std::optional<Mesh> start;   ///< where scene.start names one
  std::vector<Points> clouds;  ///< of the nearest springs that name a file, in their order
};

/// Reads them. Errors name the scene and the place in it besides. notes: as of read_mesh(). Throws what read_mesh()
/// throws.
SceneMeshes read_scene_meshes(const ElasticScene& scene, const Progress& progress = {},
                              std::vector<std::string>* notes = nullptr);

/// All that a run depends on besides its scene: a run that goes on from here gives the same bits as one that was never
/// stopped.
struct ElasticRunState {
  ElasticState state;
  std::vector<ElasticState> refined_at;  ///< the state before each refinement of the control mesh
  bool at_rest = false;                  ///< does not move any more
  std::uint64_t body = 0;                ///< which body: a checksum of the rest shape's points and faces
};

/// Writes a state file; doubles are kept bit for bit. Throws Error(FileNotWritable).
void write_state(const std::string& path, const ElasticRunState& state);
/// Throws Error(FileNotReadable), and Error(BadFile) for a file that is no state, is cut short or was changed.
ElasticRunState read_state(const std::string& path);

/// One step of a run.
struct ElasticRow {
  double time = 0.0;  ///< at its end, seconds
  StepReport step;
  MotionMeasure measure;  ///< at its end
  double speed = 0.0;     ///< root mean square of how far control points moved, per second
  Index vertices = 0;     ///< control points
  bool at_rest = false;   ///< does not move any more (SceneRest)
};

/// One thread at a time.
class ElasticRun {
 public:
  /// Builds all parts. Throws what ElasticSurface, the forces and ElasticMotion throw, Error(BadShape) for a start mesh
  /// with other faces, Error(BadArgument) for more than ten million steps; errors name the scene and the part.
  ElasticRun(const ElasticScene& scene, const SceneMeshes& meshes, const Progress& progress = {});
  explicit ElasticRun(const ElasticScene& scene, const Progress& progress = {})
      : ElasticRun(scene, read_scene_meshes(scene), progress) {}
  ~ElasticRun();
  ElasticRun(ElasticRun&&) noexcept;
  ElasticRun& operator=(ElasticRun&&) noexcept;

  const ElasticScene& scene() const;
  const ElasticMotion& motion() const;
  const ElasticState& state() const;
  const Scheme& scheme() const;
  Index refined() const;  ///< how often the control mesh was refined since the start
  bool at_rest() const;
  /// The time is over, or nothing moves and the scene ends then.
  bool done() const;
  /// The greatest k for which the time of frame k, k / frames_per_second, has come.
  Index frame() const;

  /// The control mesh as it stands: points, attributes and tags.
  Mesh mesh() const;
  /// Control points of the mesh refined `refined` times as those of the mesh of now: the same surface. Throws
  /// Error(BadShape).
  Points refined_points(ConstValuesRef points, Index refined) const;
  /// All springs as lines: row 2 i where spring i takes hold of the surface with these control points, row 2 i + 1
  /// where it pulls to at that time. Throws Error(BadShape).
  Points spring_lines(const Points& positions, double time) const;

  /// One step, after a refinement if one is due. Throws what ElasticMotion throws; then the run is as before.
  ElasticRow step(const Progress& progress = {});
  /// Goes to the static solution at this time.
  EquilibriumReport find_equilibrium(const Progress& progress = {});

  ElasticRunState save() const;
  /// Goes on from a state that was saved by a run of the same scene. Throws Error(BadArgument) for one of another body.
  void resume(const ElasticRunState& saved, const Progress& progress = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
