/// \file From a control mesh to its pictures: the surface, its colours, the bar, panels, the turntable.
#pragma once
#include <functional>
#include <optional>

#include "batten/mesh/topology.h"
#include "cli/arguments.h"
#include "cli/job.h"

namespace batten::cli {

/// What a verb has to show. The meshes and the targets must outlive the drawing.
struct Subject {
  const Mesh* control = nullptr;     ///< the control mesh, or what is drawn as it is; with its colours at the vertices
  std::optional<Topology> topology;  ///< of `control`, where the verb has it
  Scheme scheme;
  int levels = -1;            ///< refinement before the limit positions; -1: as many as make the picture smooth
  bool flat = false;          ///< as it is, not its surface
  bool draw_control = false;  ///< as lines
  Mesh lines;                 ///< its edges are drawn too; faces may have two corners
  Points markers = Points(0, 3);
  double marker_radius = 0.0;       ///< in the mesh's unit; 0: the renderer's choice
  const Points* targets = nullptr;  ///< of the vertices, for Coloring::Error
  /// Instead of a Coloring: one a marker, or where there is no marker one a vertex of `control`, linear over its faces.
  Scalars numbers;
  ScaleRequest numbers_scale;
  const Mesh* before = nullptr;  ///< as it is, for the left panel
  std::string before_caption;
  std::string after_caption;
};

/// Draws with the job's axis up, and writes. What is left out of the picture is said on stderr and added to the job's
/// notes. Throws what the operators throw, and Error(NotAvailable) in a build without pictures.
void draw(const Subject& subject, const PictureArguments& arguments, Job& job);

/// The request that --color mean makes.
ScaleRequest mean_curvature_scale();

/// Several side by side, in two rows if there are more than three, each with its after_caption, from one viewpoint.
/// Their numbers, given or of a colouring, have one scale, that of the last subject's request over the numbers of all,
/// and its bar.
void draw_row(const std::vector<Subject>& subjects, const PictureArguments& arguments, Job& job);

/// Pictures NAME-000, NAME-001, ... of subjects that are made when their turn comes, all from the viewpoint that shows
/// the first and the last.
void draw_frames(Index count, const std::function<Subject(Index)>& subject_of, const PictureArguments& arguments,
                 Job& job);

}  // namespace batten::cli
