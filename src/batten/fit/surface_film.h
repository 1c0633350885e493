/// \file The surfaces that lead to a fit: shown one after the other, or kept as one film.
#pragma once
#include <functional>
#include <vector>

#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"
#include "batten/tessellate/moving_surface.h"

namespace batten {

/// One surface on the way.
struct SurfaceFrame {
  Topology topology;  ///< of the control mesh
  Scheme scheme;
  Points control;  ///< V-by-3
};

/// Is shown the surface that a fit starts from and that after each round, by the thread that runs the fit. What it
/// throws ends the fit.
using FrameWatcher = std::function<void(const SurfaceFrame&)>;

/// A frame of its own: the control mesh, with its scheme stated.
Mesh frame_mesh(const SurfaceFrame& frame);

/// Keeps frames. A film begins anew with a frame whose control mesh is neither that of the frame before nor that one
/// refined once.
class SurfaceFilm {
 public:
  void add(const SurfaceFrame& frame);

  Index size() const { return static_cast<Index>(frames_.size()); }
  /// Frame i, from 0, on its own control mesh.
  const SurfaceFrame& frame(Index i) const { return frames_.at(static_cast<std::size_t>(i)); }
  /// The control points of frame i refined as often as the last frame's control mesh: the same surface.
  Points on_last_mesh(Index i) const;
  /// All frames as one mesh that moves: the surface tessellated `levels` deep below the last control mesh, frame i at i
  /// / frames_per_second seconds. Throws Error(BadArgument) without frames, and what surface_through_time() throws.
  MovingSurface moving(double frames_per_second, int levels, const Progress& progress = {}) const;

 private:
  std::vector<SurfaceFrame> frames_;
  std::vector<int> levels_;  ///< how often the control mesh of each frame was refined since the first
};

}  // namespace batten
