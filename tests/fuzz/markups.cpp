/// Fuzz target of 3D Slicer's points: any bytes are finite points, or an Error.
#include "batten/volume/marked_points.h"

#include "batten/error.h"
#include "fuzz/memory.h"

namespace batten::fuzz {
namespace {

void check(std::string_view text) {
  try {
    const Points points = marked_points("input", text);
    require(points.rows() > 0, "no points and no error");
    require(points.allFinite(), "points that are not finite");
  } catch (const Error& error) {
    require(std::string_view(error.what()).substr(0, 6) == "input:", "an error that does not name its file");
  }
}

}  // namespace
}  // namespace batten::fuzz

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  batten::fuzz::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
