/// \file What makes a new mesh from a mesh or from points.
#pragma once
#include <memory>
#include <string>

#include "batten/expand/morph.h"
#include "studio/engine/mesh_file.h"

namespace batten::studio {

/// From one mesh to another of the same faces, as the tool's morph does it.
class ShapeMorph {
 public:
  ShapeMorph(const MeshFile& from, const Mesh& to, const Scheme& scheme);

  /// Points at time t in [0, 1].
  val at(double t) const;
  /// Writes the limit surfaces of these points as control points as an animation (GLB).
  val film(const std::string& path, double seconds, const val& report) const;

 private:
  Mesh from_;
  UpAxis up_;
  Topology topology_;
  Scheme scheme_;
  Morph morph_;
};

/// wishes: {scheme, boundary}; here and below. {points, removed}.
val denoised_points(const std::shared_ptr<MeshFile>& file, const val& wishes, int m, int passes, const val& report);
/// gains: finest bumps first. {points, labels: [[shortest, longest]]}.
val banded_points(const std::shared_ptr<MeshFile>& file, const val& wishes, const val& gains);
/// A ShapeMorph between two meshes of the same faces.
val make_morph(const std::shared_ptr<MeshFile>& from, const std::shared_ptr<MeshFile>& to, const val& wishes);
/// Iterations of ours and the papers': [{name, failure, residuals, measuredAfter, iterations, seconds, maxError}].
val compared_methods(const std::shared_ptr<MeshFile>& file, const val& wishes, const val& report);
/// A surface to points: {mesh, rms, max, outliers, rounds: [{vertices, rms, max}]}. cage: the control mesh to start
/// from, which keeps its faces, or null: one of so many vertices is found. watch: a function that is given each round
/// as Surface::drawing(), or null. When the report says stop after a round, what is there is given.
val fitted(const std::shared_ptr<MeshFile>& points, const std::shared_ptr<MeshFile>& cage, int vertices,
           double tolerance, const val& report, const val& watch);

}  // namespace batten::studio
