#include "batten/io/io.h"

#include <algorithm>
#include <filesystem>

#include "batten/error.h"
#include "batten/io/formats.h"
#include "batten/io/write_check.h"
#include "batten/progress.h"

namespace batten {

namespace {

struct Format {
  const char* extension;
  /// Null for formats that are only written.
  Mesh (*read)(const io::Source& source);
  void (*write)(io::OutputFile& file, const Mesh& mesh, io::Encoding encoding);
};

void write_glb(io::OutputFile& file, const Mesh& mesh, io::Encoding /*encoding*/) {
#ifdef BATTEN_WITH_GLTF
  io::write_glb(file, mesh);
#else
  (void)mesh;
  throw Error(ErrorCode::NotAvailable,
              file.name() + ": this build writes no GLB; configure with BATTEN_WITH_GLTF=ON, or write obj or usda");
#endif
}

constexpr Format kFormats[] = {
    {"obj", io::read_obj, [](io::OutputFile& file, const Mesh& mesh, io::Encoding) { io::write_obj(file, mesh); }},
    {"ply", io::read_ply, io::write_ply},
    {"off", io::read_off, [](io::OutputFile& file, const Mesh& mesh, io::Encoding) { io::write_off(file, mesh); }},
    {"stl", io::read_stl, io::write_stl},
    {"xyz", io::read_xyz, [](io::OutputFile& file, const Mesh& mesh, io::Encoding) { io::write_xyz(file, mesh); }},
    {"glb", nullptr, write_glb},
    {"usda", nullptr, [](io::OutputFile& file, const Mesh& mesh, io::Encoding) { io::write_usda(file, mesh); }},
};

/// The requested format, or that of the extension. A leading dot and capital letters are ignored.
const Format& find_format(const std::string& path, const std::string& asked) {
  std::string wanted = asked.empty() ? std::filesystem::path(path).extension().string() : asked;
  if (!wanted.empty() && wanted[0] == '.') wanted.erase(0, 1);
  std::transform(wanted.begin(), wanted.end(), wanted.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  std::string known;
  for (const Format& format : kFormats) {
    if (wanted == format.extension) return format;
    known += std::string(known.empty() ? "" : ", ") + format.extension;
  }
  const std::string what = wanted.empty() ? "no file type" : "the file type '" + wanted + "' is unknown";
  throw Error(ErrorCode::UnknownFormat,
              (path == "-" ? "standard input or output" : path) + ": " + what + "; give one of " + known);
}

/// Some editors begin a file with UTF-8's byte order mark, which carries no information.
std::string_view without_byte_order_mark(std::string_view bytes) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return bytes.substr(0, kMark.size()) == kMark ? bytes.substr(kMark.size()) : bytes;
}

}  // namespace

std::string file_format(const std::string& path, const std::string& wish) { return find_format(path, wish).extension; }

Mesh read_mesh(const std::string& path, const std::string& format, const Progress& progress,
               std::vector<std::string>* notes) {
  constexpr double kFetched = 0.2;  // of the time
  const Format& known = find_format(path, format);
  if (known.read == nullptr) {
    throw Error(ErrorCode::UnknownFormat,
                path + ": " + known.extension + " is only written; read the mesh that it was made from");
  }
  const io::InputFile file(path, progress_within(progress, 0.0, kFetched));
  return known.read({path == "-" ? "standard input" : path, without_byte_order_mark(file.bytes()), io::kChunkBytes,
                     progress_within(progress, kFetched, 1.0), notes});
}

void write_mesh(const std::string& path, const Mesh& mesh, const WriteOptions& options, const Progress& progress) {
  const Format& known = find_format(path, options.format);
  const std::string name = path == "-" ? "standard output" : path;
  io::require_writable(name, mesh);
  write_atomically(path, [&](const std::string& target) {
    io::OutputFile file(target, name, progress);
    known.write(file, mesh, options.binary ? io::Encoding::Binary : io::Encoding::Text);
    file.close();
  });
}

}  // namespace batten
