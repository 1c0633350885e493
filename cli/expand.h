/// \file What the verbs of the mesh series share.
#pragma once
#include "batten/expand/bands.h"
#include "batten/expand/mesh_series.h"
#include "cli/arguments.h"

namespace batten::cli {

/// Throws Error(BadArgument) where there are only points.
void require_faces(const CommonArguments& common, const Mesh& mesh);

/// The mesh with other points; normals of the old ones are left out.
Mesh with_points(const Mesh& mesh, const Points& points);

/// 0 for a mesh without edges.
double mean_edge_length(const Topology& topology, ConstValuesRef points);

/// "limit" or "cotangent"; and with the scheme, for the table.
const char* weights_word(SeriesMatrix matrix);
std::string weights_text(const Scheme& scheme, SeriesMatrix matrix);

/// The mesh as it is after the vertices were moved; before it with --before-after; coloured by Coloring::Moved.
void draw_moved(const Mesh& before, const Mesh& after, const PictureArguments& picture, const std::string& caption,
                bool quiet);

/// The bands' sizes (root mean squares, in the mesh's unit) by how long their bumps are, as given and with their gains.
/// Throws Error(NotAvailable) as draw does.
void plot_bands(const std::string& path, const std::vector<Band>& bands, const std::vector<double>& sizes,
                const std::vector<double>& gains);

}  // namespace batten::cli
