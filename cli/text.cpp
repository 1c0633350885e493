#include "cli/text.h"

#include <fmt/format.h>

#include <cmath>

#include "batten/mesh/vertex_fields.h"

namespace batten::cli {

std::string grouped(std::int64_t number) {
  std::string text = std::to_string(number);
  for (auto place = static_cast<std::ptrdiff_t>(text.size()) - 3; place > (number < 0 ? 1 : 0); place -= 3) {
    text.insert(static_cast<std::size_t>(place), ",");
  }
  return text;
}

std::string count_of(std::int64_t number, const std::string& singular, const std::string& plural) {
  return grouped(number) + " " + (number == 1 ? singular : plural);
}

std::string fixed_text(double value, int decimals) {
  const double size = std::abs(value);
  const bool fits = size == 0.0 || (size >= std::pow(10.0, 1 - decimals) && size < 1e9);
  return fits ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:.4g}", value);
}

std::string size_text(const Mesh& mesh) {
  return count_of(mesh.vertex_count(), "vertex", "vertices") + ", " + count_of(mesh.face_count(), "face", "faces");
}

std::string mesh_text(const Topology& topology) {
  std::string text =
      count_of(topology.vertex_count(), "vertex", "vertices") + ", " + count_of(topology.face_count(), "face", "faces");
  const Index isolated = isolated_count(topology);
  if (isolated > 0)
    text += fmt::format(" ({} without a face, passed through)", count_of(isolated, "vertex", "vertices"));
  return text;
}

const char* face_varying_word(FaceVaryingRule rule) {
  constexpr const char* kWords[] = {"none", "corners-only", "corners-plus1", "corners-plus2", "boundaries", "all"};
  return kWords[static_cast<std::size_t>(rule)];
}

std::string scheme_text(const Scheme& scheme) {
  std::string text = scheme_name(scheme.kind);
  switch (scheme.boundary) {
    case BoundaryRule::None:
      text += ", boundary none";
      break;
    case BoundaryRule::EdgeOnly:
      text += ", boundary edge-only";
      break;
    case BoundaryRule::EdgeAndCorner:
      text += ", boundary edge-and-corner";
      break;
  }
  if (scheme.crease_method == CreaseMethod::Chaikin) text += ", Chaikin creases";
  if (scheme.triangle_rule == TriangleRule::Smooth) text += ", smooth triangles";
  if (!scheme.has_linear_corners()) text += std::string(", face-varying ") + face_varying_word(scheme.face_varying);
  if (is_interpolating(scheme.kind)) {
    if (scheme.butterfly_boundary == ButterflyBoundary::Reflect) text += ", by reflection";
    if (scheme.tension) text += fmt::format(", tension {:g}", *scheme.tension);
  }
  if (scheme.alpha > 0.0) text += fmt::format(", alpha {:g} in the first step", scheme.alpha);
  return text;
}

std::string seams_text(Index count, bool repaired) {
  return count_of(count, "vertex of open edges lies", "vertices of open edges lie") + " on others: seams stay open" +
         (repaired ? "" : "; --repair welds them");
}

std::string features_text(const std::vector<Crease>& features, double degrees) {
  return count_of(static_cast<std::int64_t>(features.size()), "sharp edge", "sharp edges") +
         fmt::format(" of over {:g} degrees", degrees);
}

std::string method_text(const SolveReport& report) {
  if (report.iterations == 0) return report.method_name;
  return report.method_name + ", " + count_of(report.iterations, "iteration", "iterations");
}

}  // namespace batten::cli
