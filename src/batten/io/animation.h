/// \file Writes a mesh with an animation.
#pragma once
#include <string>

#include "batten/io/io.h"
#include "batten/mesh/morph_targets.h"
#include "batten/types.h"

namespace batten {

/// Writes a GLB: the mesh as write_mesh() writes it, with morph targets for positions and normals and an animation of
/// their weights, which are linear between the times. Viewers play it; a program without animations shows the mesh at
/// the first time. Throws what write_mesh throws, Error(UnknownFormat) for other file types, and Error(BadShape,
/// BadArgument, NotFinite) for targets that do not fit the mesh or times that do not increase.
void write_animation(const std::string& path, const Mesh& mesh, const MorphTargets& targets,
                     const WriteOptions& options = {}, const Progress& progress = {});

}  // namespace batten
