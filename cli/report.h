/// \file What --report writes.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "batten/mesh/repair.h"
#include "batten/scheme/scheme.h"

namespace batten::cli {

/// Writes the file whole or not at all; does nothing for an empty path.
void write_json(const std::string& path, const nlohmann::ordered_json& json);
nlohmann::ordered_json repairs_json(const RepairResult& repaired);
nlohmann::ordered_json scheme_json(const Scheme& scheme);
/// The two vertices of each.
nlohmann::ordered_json edges_json(const std::vector<Crease>& edges);
/// The most memory this process has held, in bytes; 0 where the system does not tell.
std::int64_t peak_memory_bytes();

}  // namespace batten::cli
