/// Fuzz target of a reader, BATTEN_FUZZ_READER: any bytes are a mesh or an Error, in little memory, and cutting the
/// text into pieces changes nothing.
#include <optional>

#include "batten/io/formats.h"
#include "batten/io/write_check.h"
#include "fuzz/memory.h"

namespace batten::fuzz {
namespace {

/// A mesh, or why there is none.
struct Outcome {
  std::optional<Mesh> mesh;
  std::string error;
};

Outcome read(std::string_view bytes, std::size_t chunk_bytes) {
  try {
    return {io::BATTEN_FUZZ_READER({"input", bytes, chunk_bytes}), ""};
  } catch (const Error& error) {
    return {std::nullopt, error.what()};
  }
}

bool same(const Mesh& a, const Mesh& b) {
  return a.points == b.points && a.face_offsets == b.face_offsets && a.face_vertices == b.face_vertices &&
         a.attributes.size() == b.attributes.size() && a.creases.size() == b.creases.size() &&
         a.corners.size() == b.corners.size() && a.holes == b.holes && a.groups.size() == b.groups.size();
}

void check(std::string_view bytes) {
  constexpr std::size_t kMostTimes = 64;
  constexpr std::size_t kFixed = std::size_t{1} << 16;
  constexpr std::size_t kTinyPiece = 24;
  Outcome whole;
  const std::size_t memory = peak_bytes([&] { whole = read(bytes, io::kChunkBytes); });
  require(memory <= kMostTimes * bytes.size() + kFixed, "more memory than 64 times the file");
  const Outcome pieces = read(bytes, kTinyPiece);
  require(whole.error == pieces.error,
          "another error when the text is cut into pieces:\n  " + whole.error + "\n  " + pieces.error);
  if (!whole.mesh) return;
  require(same(*whole.mesh, *pieces.mesh), "another mesh when the text is cut into pieces");
  io::require_writable("what was read", *whole.mesh);
}

}  // namespace
}  // namespace batten::fuzz

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  // The tool refuses an empty file before any reader sees it.
  if (size > 0) batten::fuzz::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
