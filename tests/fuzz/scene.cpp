/// Fuzz target of scenes of elastic surfaces: any bytes are a scene whose numbers are finite, or an Error, in little
/// memory. No file is opened.
#include <cmath>
#include <optional>

#include "batten/dynamics/scene.h"
#include "batten/error.h"
#include "fuzz/memory.h"

namespace batten::fuzz {
namespace {

bool is_sound(const ScenePlace& place) {
  const int ways = (place.place ? 1 : 0) + (place.vertex ? 1 : 0) + (place.near ? 1 : 0);
  return ways == 1 && (!place.near || place.near->allFinite());
}

bool is_sound(const ScenePath& path) {
  return !path.points.empty() && (path.times.empty() || path.times.size() == path.points.size());
}

void require_sound(const ElasticScene& scene) {
  require(!scene.mesh.empty(), "a scene without a mesh");
  require(scene.move.allFinite() && scene.velocity.allFinite(), "a start that is not finite");
  const SceneTime& time = scene.time;
  require(time.seconds >= 0.0 && time.motion.step > 0.0 && time.seconds / time.motion.step <= 1e7, "too many steps");
  for (const double density : scene.body.material.density) require(density >= 0.0, "a negative density");
  for (const SceneForce& force : scene.forces) {
    if (const auto* spring = std::get_if<SceneSpring>(&force))
      require(is_sound(spring->at) && is_sound(spring->to) && spring->stiffness >= 0.0, "a bad spring");
    if (const auto* wind = std::get_if<SceneWind>(&force))
      require(wind->velocity.allFinite() && wind->length > 0.0, "a bad wind");
  }
  for (const SceneSupport& support : scene.supports) {
    if (const auto* pin = std::get_if<ScenePin>(&support)) require(is_sound(pin->at), "a bad pin");
  }
}

void check(std::string_view text) {
  constexpr std::size_t kMostTimes = 1024;  // an empty object takes two bytes of text, and as a tree a hundred
  constexpr std::size_t kFixed = std::size_t{1} << 16;
  std::optional<ElasticScene> scene;
  const std::size_t memory = peak_bytes([&] {
    try {
      scene = parse_scene("input", text);
    } catch (const Error& error) {
      require(error.what()[0] != '\0', "an error without words");
    }
  });
  require(memory <= kMostTimes * text.size() + kFixed, "more memory than 1024 times the text");
  if (scene) require_sound(*scene);
}

}  // namespace
}  // namespace batten::fuzz

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  batten::fuzz::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
