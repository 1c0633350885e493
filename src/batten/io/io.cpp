#include "batten/io/io.h"

#include <algorithm>
#include <filesystem>

#include "batten/error.h"
#include "batten/io/formats.h"
#include "batten/io/gzip.h"
#include "batten/io/obj_library.h"
#include "batten/io/write_check.h"
#include "batten/progress.h"

namespace batten {

namespace {

struct Format {
  const char* extension;
  /// Null for formats that are only written.
  Mesh (*read)(const io::Source& source);
  /// Null for formats that are only read. `path` is that of the file when it is complete.
  void (*write)(const std::string& path, io::OutputFile& file, const Mesh& mesh, const WriteOptions& options);
  /// What its programs mostly use.
  UpAxis usual_up;
};

io::Encoding encoding_of(const WriteOptions& options) {
  return options.binary ? io::Encoding::Binary : io::Encoding::Text;
}

void write_obj(const std::string& path, io::OutputFile& file, const Mesh& mesh, const WriteOptions& options) {
  const io::ObjLibrary library(path, mesh);
  if (!options.comment.empty()) file.write("# " + options.comment + "\n");
  io::write_obj(file, mesh, library.libraries());
  library.write();
}

void write_glb(const std::string& /*path*/, io::OutputFile& file, const Mesh& mesh, const WriteOptions& options) {
#ifdef BATTEN_WITH_GLTF
  io::write_glb(file, mesh, io::up_axis_to_write(mesh, options.up));
#else
  (void)mesh;
  (void)options;
  throw Error(ErrorCode::NotAvailable,
              file.name() + ": this build writes no GLB; configure with BATTEN_WITH_GLTF=ON, or write obj or usda");
#endif
}

Mesh read_gltf(const io::Source& source) {
#ifdef BATTEN_WITH_GLTF
  return io::read_gltf(source);
#else
  throw Error(ErrorCode::NotAvailable, source.name + ": this build reads no glTF; configure with BATTEN_WITH_GLTF=ON");
#endif
}

constexpr Format kFormats[] = {
    {"obj", io::read_obj, write_obj, UpAxis::Y},
    {"ply", io::read_ply,
     [](const std::string&, io::OutputFile& file, const Mesh& mesh, const WriteOptions& options) {
       io::write_ply(file, mesh, encoding_of(options), options.comment);
     },
     UpAxis::Y},
    {"off", io::read_off,
     [](const std::string&, io::OutputFile& file, const Mesh& mesh, const WriteOptions&) { io::write_off(file, mesh); },
     UpAxis::Y},
    {"stl", io::read_stl,
     [](const std::string&, io::OutputFile& file, const Mesh& mesh, const WriteOptions& options) {
       io::write_stl(file, mesh, encoding_of(options), options.comment);
     },
     UpAxis::Z},
    {"xyz", io::read_xyz,
     [](const std::string&, io::OutputFile& file, const Mesh& mesh, const WriteOptions&) { io::write_xyz(file, mesh); },
     UpAxis::Z},
    {"glb", read_gltf, write_glb, UpAxis::Y},
    {"gltf", read_gltf, nullptr, UpAxis::Y},
    {"usda", nullptr,
     [](const std::string&, io::OutputFile& file, const Mesh& mesh, const WriteOptions& options) {
       io::write_usda(file, mesh, io::up_axis_to_write(mesh, options.up));
     },
     UpAxis::Y},
    {"vtk", nullptr,
     [](const std::string&, io::OutputFile& file, const Mesh& mesh, const WriteOptions& options) {
       io::write_vtk(file, mesh, encoding_of(options), options.comment);
     },
     UpAxis::Z},
    {"fsb", nullptr,
     [](const std::string&, io::OutputFile& file, const Mesh& mesh, const WriteOptions& options) {
       io::write_freesurfer(file, mesh, encoding_of(options), options.comment);
     },
     UpAxis::Z},
    {"gii", nullptr,
     [](const std::string&, io::OutputFile& file, const Mesh& mesh, const WriteOptions& options) {
       io::write_gifti(file, mesh, encoding_of(options));
     },
     UpAxis::Z},
};

/// The extension in lower case and without the dot.
std::string plain_extension(std::string extension) {
  if (!extension.empty() && extension[0] == '.') extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

bool has_gzip_extension(const std::filesystem::path& path) {
  return plain_extension(path.extension().string()) == "gz";
}

/// The requested format, or that of the extension. A leading dot and capital letters are ignored.
const Format& find_format(const std::string& path, const std::string& asked) {
  const std::filesystem::path file(path);
  const std::filesystem::path plain = has_gzip_extension(file) ? file.stem() : file;
  const std::string wanted = plain_extension(asked.empty() ? plain.extension().string() : asked);
  std::string known;
  for (const Format& format : kFormats) {
    if (wanted == format.extension) return format;
    known += std::string(known.empty() ? "" : ", ") + format.extension;
  }
  if (path.empty())
    throw Error(ErrorCode::UnknownFormat, "a file's name is empty; give one that ends with one of " + known);
  const std::string what = wanted.empty() ? "no file type" : "the file type '" + wanted + "' is unknown";
  throw Error(ErrorCode::UnknownFormat,
              (path == "-" ? "standard input or output" : path) + ": " + what + "; give one of " + known);
}

/// Some editors begin a file with UTF-8's byte order mark, which carries no information.
std::string_view without_byte_order_mark(std::string_view bytes) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return bytes.substr(0, kMark.size()) == kMark ? bytes.substr(kMark.size()) : bytes;
}

Mesh read_bytes(const Format& format, io::Source source) {
  source.bytes = without_byte_order_mark(source.bytes);
  return format.read(source);
}

}  // namespace

UpAxis find_up_axis(const Mesh& mesh, const std::string& format) {
  const Format& known = find_format(format, format);
  const bool is_certain = known.read == read_gltf;
  return is_certain ? known.usual_up : guess_up_axis(mesh, known.usual_up);
}

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
  io::Source source{path == "-" ? "standard input" : path, file.bytes(), io::kChunkBytes,
                    progress_within(progress, kFetched, 1.0), notes};
  if (!io::is_gzip(source.bytes)) return read_bytes(known, source);
  constexpr double kUnpacked = 0.5;  // of the rest
  const Progress rest = source.progress;
  source.progress = progress_within(rest, 0.0, kUnpacked);
  const Buffer<char> unpacked = io::unpack_gzip(source);
  source.progress = progress_within(rest, kUnpacked, 1.0);
  source.bytes = {unpacked.data(), unpacked.size()};
  return read_bytes(known, source);
}

void write_mesh(const std::string& path, const Mesh& mesh, const WriteOptions& options, const Progress& progress) {
  const Format& known = find_format(path, options.format);
  if (known.write == nullptr) {
    throw Error(ErrorCode::UnknownFormat, path + ": " + known.extension + " is only read; write glb instead");
  }
  if (has_gzip_extension(path)) {
    throw Error(ErrorCode::UnknownFormat, path + ": .gz files are only read; write the file without it, then gzip it");
  }
  const std::string name = path == "-" ? "standard output" : path;
  io::require_writable(name, mesh);
  if (options.comment.find_first_of("\r\n") != std::string::npos)
    throw Error(ErrorCode::BadArgument, name + ": a comment has no line end");
  write_atomically(path, [&](const std::string& target) {
    io::OutputFile file(target, name, progress);
    known.write(path, file, mesh, options);
    file.close();
  });
}

}  // namespace batten
