#include "cli/report.h"

#include <fstream>

#include "batten/output.h"
#include "cli/text.h"

namespace batten::cli {

void write_json(const std::string& path, const nlohmann::ordered_json& json) {
  if (path.empty()) return;
  const std::string text = json.dump(2) + '\n';
  write_bytes(path, Buffer<unsigned char>(text.begin(), text.end()));
}

nlohmann::ordered_json repairs_json(const RepairResult& repaired) {
  nlohmann::ordered_json changes = nlohmann::ordered_json::array();
  for (const RepairChange& change : repaired.changes) {
    changes.push_back({{"kind", repair_word(change.kind)},
                       {"count", change.count},
                       {"elements", change.elements},
                       {"text", change.text}});
  }
  return {{"changes", changes},
          {"vertex_sources", repaired.vertex_sources},
          {"face_sources", repaired.face_sources},
          {"vertex_targets", repaired.vertex_targets},
          {"face_targets", repaired.face_targets}};
}

nlohmann::ordered_json edges_json(const std::vector<Crease>& edges) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Crease& edge : edges) json.push_back({edge.a, edge.b});
  return json;
}

nlohmann::ordered_json scheme_json(const Scheme& scheme) {
  static constexpr const char* kKinds[] = {"catmull-clark", "loop", "butterfly", "modified-butterfly"};
  static constexpr const char* kBoundaries[] = {"none", "edge-and-corner", "edge-only"};
  nlohmann::ordered_json json{{"kind", kKinds[static_cast<int>(scheme.kind)]},
                              {"boundary", kBoundaries[static_cast<int>(scheme.boundary)]},
                              {"creases", scheme.crease_method == CreaseMethod::Chaikin ? "chaikin" : "uniform"},
                              {"triangles", scheme.triangle_rule == TriangleRule::Smooth ? "smooth" : "catmark"},
                              {"face_varying", face_varying_word(scheme.face_varying)},
                              {"alpha", scheme.alpha}};
  if (is_interpolating(scheme.kind)) {
    const bool reflect = scheme.butterfly_boundary == ButterflyBoundary::Reflect;
    json["butterfly_boundary"] = reflect ? "reflect" : "crease-rules";
    if (scheme.tension) json["tension"] = *scheme.tension;
  }
  return json;
}

std::int64_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return 1024 * std::stoll(line.substr(6));
  }
  return 0;
}

}  // namespace batten::cli
