/// \file A surface that is drawn to a cloud of points, step by step.
#pragma once
#include <memory>
#include <span>

#include "batten/fit/point_cloud.h"
#include "batten/fit/surface_guard.h"
#include "batten/mesh/topology.h"
#include "batten/nearest/nearest_point.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"
#include "batten/solve/solver.h"

namespace batten {

/// How a step weighs what it makes least.
struct FitStep {
  /// What the energy of the whole surface counts beside the mean squared distance; the same number means about the same
  /// for any number of control points and any unit.
  double fairness = 1e-3;
  double evenness = 1e-2;  ///< the same for moves along the surface, which keeps the parameters even
  /// What places of the surface, drawn to the nearest points of the data, count beside points drawn to the surface.
  double pull = 1.0;
  /// The same for all moves of control points that are held; where it is not 0 there is no evenness.
  double mending = 0.0;
  double damping = 1e-4;    ///< holds control points where they are, as a share of what points pull them
  double tolerance = 1e-3;  ///< of the linear system, relative
  int max_iterations = 200;
};

/// Attach, step, attach, ... (docs/fit.md). A step makes the sum of weighted models of squared distances
/// (fit/squared_distance_model.h) and the thin-plate energy least (Cheng, Wang, Qin and others 2007, key CWQ07). Every
/// state between two calls is a whole surface. One thread changes it.
class SurfaceFitter {
 public:
  /// control: V-by-3, the start. cloud: the data, with normals, kept as a copy. Throws Error(NotTriangles, BadArgument
  /// for the Butterflies or no points, BadShape where normals are not one a point, NotFinite, TooLarge, Cancelled).
  SurfaceFitter(const Topology& topology, const Scheme& scheme, ConstValuesRef control, PointCloud cloud,
                const Progress& progress = {});
  ~SurfaceFitter();
  SurfaceFitter(SurfaceFitter&&) noexcept;
  SurfaceFitter& operator=(SurfaceFitter&&) noexcept;

  const Topology& topology() const;
  const Scheme& scheme() const;
  const Values& control() const;
  const PointCloud& cloud() const;

  /// Finds the nearest point of the surface for each point of the data. A step needs it first.
  void attach(const Progress& progress = {});
  /// Of the last attach(), a place a point.
  std::span<const NearestPoint> attached() const;
  /// Of the last attach(): from each point to the surface.
  const Scalars& distances() const;

  /// Other data for the same surface, with normals; all weights are 1 again. A step needs attach() first. Throws
  /// Error(BadArgument, BadShape, NotFinite).
  void set_cloud(PointCloud cloud);

  /// The median distance between neighbouring points of the data.
  double spacing() const;

  /// One a point, not negative; all 1 at first.
  void set_weights(Scalars weights);
  const Scalars& weights() const;

  /// The weighted mean of the squared distances of the last attach(), plus the fairness.
  double objective(double fairness) const;

  /// How the control points should move; nothing moves yet.
  Values find_step(const FitStep& options, SolveReport* report = nullptr) const;
  /// Moves the surface. Attachments are then those of the surface before, until attach() is called.
  void move_to(const Values& control);

  /// The control points after a step, where control points go a shorter way or none before faces around them fold over
  /// or, as asked, pass through others. The surface does not move. control, step: V-by-3. Throws Error(BadShape,
  /// NotFinite).
  Values stepped(const Values& control, const Values& step, Soundness asked = Soundness::Whole);

  /// True where the last stepped() held control points.
  bool has_held() const;
  /// The last find_step() again, where these control points move as in `moves` and the others as suits that.
  Values find_step_beside(const FitStep& options, const Values& moves) const;

  /// Moves control points that the last stepped() held along the surface towards the mean of their neighbours, so that
  /// they can go on; false where there are none. With Unfolded the surface may fold or pass through itself afterwards.
  bool relax(Soundness asked = Soundness::Whole);

  /// Faces of the control mesh whose surface folds over or passes through another's.
  Index unsound_faces() const;
  /// The same where the control points were these, V-by-3.
  Index unsound_faces(const Values& control) const;
  /// Moves the control points of these faces a part of the way to the mean of their neighbours, on sharp lines of
  /// those on the lines: off the points, where nothing else makes the surface sound.
  void even_out_unsound(double part);
  /// Holds the control points around these faces, so that relax() moves them; returns how many faces there are.
  Index hold_unsound();

  /// Refines the control mesh; the surface stays where it is.
  void refine();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
