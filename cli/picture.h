/// \file From a control mesh to its pictures: the surface, its colours, the bar, panels, the turntable.
#pragma once
#include <optional>

#include "batten/mesh/topology.h"
#include "cli/arguments.h"

namespace batten::cli {

/// What a verb has to show.
struct Subject {
  Mesh control;  ///< the control mesh, or what is drawn as it is; its colours at the vertices are drawn too
  Scheme scheme;
  int levels = -1;            ///< refinement before the limit positions; -1: as many as make the picture smooth
  bool flat = false;          ///< as it is, not its surface
  bool draw_control = false;  ///< as lines
  Points markers = Points(0, 3);
  double marker_radius = 0.0;     ///< in the mesh's unit; 0: the renderer's choice
  std::optional<Points> targets;  ///< of the vertices, for Coloring::Error
  Scalars numbers;                ///< instead of a Coloring: one a marker, or one a vertex where there is no marker
  ScaleRequest numbers_scale;
  Mesh before;  ///< as it is, for the left panel
  std::string before_caption;
  std::string after_caption;
};

/// Levels that make some 400,000 faces, but at most 5.
int picture_levels(const Topology& topology);

/// Draws and writes. Throws what the operators throw, and Error(NotAvailable) in a build without pictures.
void draw(const Subject& subject, const PictureArguments& arguments, bool quiet);

/// The request that --color mean makes.
ScaleRequest mean_curvature_scale();

/// Several side by side, each with its after_caption, from one viewpoint. Their numbers have one scale, that of the
/// last subject's request over the numbers of all, and its bar; colourings have none.
void draw_row(const std::vector<Subject>& subjects, const PictureArguments& arguments, bool quiet);

}  // namespace batten::cli
