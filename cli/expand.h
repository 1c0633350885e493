/// \file What the verbs of the mesh series share.
#pragma once
#include "batten/expand/mesh_series.h"
#include "cli/job.h"

namespace batten::cli {

/// Throws Error(BadArgument) where there are only points.
void require_faces(const CommonArguments& common, const Mesh& mesh);

/// "limit" or "cotangent"; and with the scheme, for the table.
const char* weights_word(SeriesMatrix matrix);
std::string weights_text(const Scheme& scheme, SeriesMatrix matrix);

/// Draws the mesh after its vertices were moved, coloured by how far; with --before-after beside the mesh before.
void draw_moved(const Mesh& before, const Mesh& after, const PictureArguments& picture, const std::string& caption,
                Job& job);

}  // namespace batten::cli
