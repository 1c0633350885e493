/// Fuzz target of medial models: any bytes are a sound model or an Error; what was read is written so that it reads
/// back the same, and its boundary is a mesh that Topology accepts, or an Error.
#include "batten/medial/medial_boundary.h"
#include "batten/medial/medial_formats.h"
#include "batten/mesh/topology.h"
#include "fuzz/memory.h"

namespace batten::fuzz {
namespace {

constexpr const char* kName = "input";

bool same(const MedialModel& a, const MedialModel& b) {
  if (a.figures.size() != b.figures.size() || a.hinges.size() != b.hinges.size()) return false;
  for (std::size_t i = 0; i < a.figures.size(); ++i) {
    const MedialFigure& one = a.figures[i];
    const MedialFigure& other = b.figures[i];
    if (one.name != other.name || one.sheet.points != other.sheet.points || one.up != other.up ||
        one.down != other.down || one.crest.size() != other.crest.size() ||
        one.sheet.face_vertices != other.sheet.face_vertices)
      return false;
  }
  return true;
}

void check(std::string_view text) {
  MedialModel model;
  try {
    model = medial::model_from_text(kName, text);
  } catch (const Error& error) {
    require(error.what()[0] != '\0', "an error without words");
    return;
  }
  const MedialModel again = medial::model_from_text(kName, io::json_text(medial::figures_to_json(model)));
  require(same(model, again), "another model when it is written and read again");
  try {
    const MedialBoundary boundary = medial_boundary(model);
    require(boundary.mesh.points.allFinite(), "spoke ends that are not finite");
    Topology(boundary.mesh);
  } catch (const Error& error) {
    require(error.what()[0] != '\0', "an error without words");
  }
}

}  // namespace
}  // namespace batten::fuzz

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  batten::fuzz::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
