#include "batten/io/glb_model.h"

#include <exception>
#include <filesystem>
#include <limits>
#include <new>

#include "batten/error.h"

namespace batten::io {

namespace {

/// The first line of a message.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Decoding images would take most of the time.
bool keep_image(tinygltf::Image* image, int /*index*/, std::string* /*error*/, std::string* /*warning*/, int /*width*/,
                int /*height*/, const unsigned char* bytes, int size, void* /*user*/) {
  if (image->bufferView < 0 && image->uri.empty()) image->image.assign(bytes, bytes + size);
  return true;
}

}  // namespace

void refuse_packed(const std::string& name, const std::string& packing) {
  throw Error(ErrorCode::BadFile,
              name + ": the mesh is packed by " + packing + ", which is not read; export it again without compression");
}

tinygltf::Model load_gltf(const Source& source) {
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_image, nullptr);
  std::string error;
  std::string warning;
  const std::string folder = std::filesystem::path(source.name).parent_path().string();
  if (source.bytes.size() > std::numeric_limits<unsigned int>::max()) {
    throw Error(ErrorCode::TooLarge, source.name + ": a glTF file has at most 4 GiB");
  }
  const auto size = static_cast<unsigned int>(source.bytes.size());
  bool loaded = false;
  try {
    loaded =
        source.bytes.substr(0, 4) == "glTF"
            ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(source.bytes.data()), size, folder)
            : loader.LoadASCIIFromString(&model, &error, &warning, source.bytes.data(), size, folder);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (loaded) return model;
  // A packed file may lack the buffers that tinygltf looks for.
  for (const char* packing : kGltfPackings) {
    if (source.bytes.find(packing) != std::string_view::npos) refuse_packed(source.name, packing);
  }
  throw Error(ErrorCode::BadFile,
              source.name + ": " + (error.empty() ? "this is no glTF 2.0 file" : first_line(error)));
}

}  // namespace batten::io
