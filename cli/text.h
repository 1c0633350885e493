/// \file Numbers, meshes and schemes in the words of the tables.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"
#include "batten/solve/solver.h"

namespace batten::cli {

/// "12,345"
std::string grouped(std::int64_t number);
/// "1 vertex", "12,345 vertices"
std::string count_of(std::int64_t number, const std::string& singular, const std::string& plural);
/// A number with so many decimals; with four digits where that would show less than two of it, or more than it has.
std::string fixed_text(double value, int decimals);
/// "8 vertices, 6 faces"
std::string size_text(const Mesh& mesh);
/// As size_text, and how many vertices have no face.
std::string mesh_text(const Topology& topology);
std::string scheme_text(const Scheme& scheme);
/// "corners-only", as --face-varying takes it.
const char* face_varying_word(FaceVaryingRule rule);
/// "16 vertices of open edges lie on others: seams stay open; --repair welds them"
std::string seams_text(Index count, bool repaired);
/// "596 sharp edges of over 40 degrees"
std::string features_text(const std::vector<Crease>& features, double degrees);
/// "Chebyshev in tiles, 30 iterations"; without iterations where there was none to make.
std::string method_text(const SolveReport& report);

}  // namespace batten::cli
