#include "batten/io/ply_binary.h"

#include <cmath>
#include <limits>
#include <type_traits>

#include "batten/io/bytes.h"
#include "batten/io/chunks.h"

namespace batten::io {

namespace {

/// Calls body with a value of the property's C++ type.
template <typename Body>
auto with_type(PlyType type, const Body& body) {
  switch (type) {
    case PlyType::Int8:
      return body(std::int8_t{});
    case PlyType::Uint8:
      return body(std::uint8_t{});
    case PlyType::Int16:
      return body(std::int16_t{});
    case PlyType::Uint16:
      return body(std::uint16_t{});
    case PlyType::Int32:
      return body(std::int32_t{});
    case PlyType::Uint32:
      return body(std::uint32_t{});
    case PlyType::Int64:
      return body(std::int64_t{});
    case PlyType::Uint64:
      return body(std::uint64_t{});
    case PlyType::Float32:
      return body(float{});
    case PlyType::Float64:
      break;
  }
  return body(double{});
}

/// Reads the values of a row from consecutive bytes.
template <ByteOrder Order>
struct BinaryValues {
  const char* at;
  const char* end;

  double scalar(const PlyProperty& property) {
    require(byte_size(property.type));
    return with_type(property.type, [&](auto type) { return static_cast<double>(take<decltype(type)>()); });
  }
  std::int64_t integer(PlyType type, const char* what) {
    require(byte_size(type));
    if (!is_integer(type)) fail(ErrorCode::BadFile, std::string(what) + ": the type must be an integer");
    return with_type(type, [&](auto value) { return static_cast<std::int64_t>(take<decltype(value)>()); });
  }
  void skip(PlyType type, std::int64_t count) {
    const std::size_t size = byte_size(type);
    if (static_cast<std::uint64_t>(count) > static_cast<std::uint64_t>(end - at) / size) require(end - at + 1);
    at += count * static_cast<std::int64_t>(size);
  }
  [[noreturn]] void fail(ErrorCode code, const std::string& message) const { throw Fault{at, code, message}; }

 private:
  template <typename T>
  T take() {
    const T value = load<T, Order>(at);
    at += sizeof(T);
    return value;
  }
  void require(std::size_t bytes) const {
    if (bytes > static_cast<std::size_t>(end - at))
      fail(ErrorCode::BadFile, "the file ends inside a row; it is cut short");
  }
};

/// A face row with one list, possibly with scalars before and after it.
struct FaceLayout {
  std::size_t before;  ///< bytes before the list's size
  std::size_t after;   ///< bytes after the list
  PlyType count_type;
  PlyType index_type;
};

template <ByteOrder Order>
class BinaryReader {
 public:
  BinaryReader(const Source& source, const PlyHeader& header, PlyFaceValues& faces, Mesh& mesh)
      : source_(source),
        at_(header.body),
        end_(source.bytes.data() + source.bytes.size()),
        faces_(faces),
        mesh_(mesh) {}

  void read(PlyTargets& targets) {
    const PlyElement& element = *targets.element;
    require_bytes(element);
    if (targets.role == PlyRole::Vertices) allocate_ply_vertices(targets, mesh_);
    if (!element.has_list()) {
      if (targets.role == PlyRole::Vertices) read_fixed_vertices(targets);
      at_ += element.count * element.smallest_row();
    } else if (is_single_list(targets) && mesh_.face_count() == 0) {
      read_single_list_faces(targets);
    } else {
      read_rows(targets);
    }
    if (targets.role == PlyRole::Vertices) require_finite(targets);
  }

 private:
  /// True for faces that have nothing else that is kept.
  static bool is_single_list(const PlyTargets& targets) {
    std::ptrdiff_t lists = 0;
    for (const PlyProperty& property : targets.element->properties) lists += property.is_list() ? 1 : 0;
    return targets.role == PlyRole::Faces && lists == 1 && targets.texture_number == PlyTargets::kNone;
  }

  [[noreturn]] void fail(const char* where, ErrorCode code, const std::string& message) const {
    throw Fault{where, code, message};
  }

  void report_now_and_then(std::size_t row, std::size_t count, double begin, double end) const {
    constexpr std::size_t kRowsBetween = std::size_t{1} << 20;
    if (row % kRowsBetween != 0) return;
    report_progress(source_.progress, begin + (end - begin) * static_cast<double>(row) / static_cast<double>(count));
  }

  /// Refuses counts that the file cannot hold before memory is allocated.
  void require_bytes(const PlyElement& element) const {
    const std::size_t row_bytes = element.smallest_row();
    if (row_bytes == 0 || element.count <= static_cast<std::size_t>(end_ - at_) / row_bytes) return;
    fail(at_, ErrorCode::BadFile,
         "the header promises " + std::to_string(element.count) + " rows of " + in_quotes(element.name) + ", each of " +
             std::to_string(row_bytes) + " bytes or more, but fewer are left; the file is cut short");
  }

  /// Reads rows of equal size, column by column, in blocks that fit the cache.
  void read_fixed_vertices(const PlyTargets& targets) {
    const PlyElement& element = *targets.element;
    const std::size_t row_bytes = element.smallest_row();
    const auto read_block = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      std::size_t offset = 0;
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const PlyColumn& column = targets.columns[p];
        const char* base = at_ + offset;
        with_type(element.properties[p].type, [&](auto type) {
          for (std::ptrdiff_t row = begin; row < end; ++row) {
            const auto value = load<decltype(type), Order>(base + row_bytes * static_cast<std::size_t>(row));
            column.values[column.stride * row + column.offset] = static_cast<double>(value) / column.divisor;
          }
        });
        offset += byte_size(element.properties[p].type);
      }
    };
    parallel_for(static_cast<std::ptrdiff_t>(element.count), read_block, kDefaultBlock,
                 progress_within(source_.progress, 0.0, 0.5));
  }

  void require_finite(const PlyTargets& targets) const {
    const double* values = mesh_.points.data();
    const std::ptrdiff_t bad = parallel_reduce(
        mesh_.points.size(), std::ptrdiff_t{-1},
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          bool finite = true;
          for (std::ptrdiff_t i = begin; i < end; ++i)
            finite &= std::abs(values[i]) <= std::numeric_limits<double>::max();
          for (std::ptrdiff_t i = begin; i < end && !finite; ++i) {
            if (!std::isfinite(values[i])) return i;
          }
          return std::ptrdiff_t{-1};
        },
        [](std::ptrdiff_t a, std::ptrdiff_t b) { return a >= 0 ? a : b; });
    if (bad < 0) return;
    const std::size_t row_bytes = targets.element->has_list() ? 0 : targets.element->smallest_row();
    const char* first = row_bytes == 0 ? at_ : at_ - row_bytes * targets.element->count;
    fail(first + row_bytes * static_cast<std::size_t>(bad / 3), ErrorCode::NotFinite,
         "vertex " + std::to_string(bad / 3) +
             " has a coordinate that is not finite; remove the vertex or give it a place");
  }

  void read_single_list_faces(const PlyTargets& targets) {
    const PlyProperty& list = targets.element->properties[targets.face_list];
    FaceLayout layout{0, 0, *list.count_type, list.type};
    for (std::size_t p = 0; p < targets.element->properties.size(); ++p) {
      if (p == targets.face_list) continue;
      (p < targets.face_list ? layout.before : layout.after) += byte_size(targets.element->properties[p].type);
    }
    if (!is_integer(list.type)) fail(at_, ErrorCode::BadFile, "vertices of a face must have an integer type");
    const char* first = at_;
    with_type(layout.count_type, [&](auto type) { scan_sizes<decltype(type)>(layout, targets.element->count); });
    mesh_.face_vertices.resize(static_cast<std::size_t>(mesh_.face_offsets.back()));
    with_type(layout.index_type, [&](auto type) { copy_corners<decltype(type)>(layout, first, targets.vertex_count); });
  }

  /// Walks from list to list, which cannot be done in parallel. Moves to the end of the element.
  template <typename Count>
  void scan_sizes(const FaceLayout& layout, std::size_t face_count) {
    const std::size_t fixed = layout.before + sizeof(Count) + layout.after;
    const std::size_t index_bytes = byte_size(layout.index_type);
    std::size_t corners = 0;
    mesh_.face_offsets.resize(face_count + 1);
    mesh_.face_offsets[0] = 0;
    for (std::size_t face = 0; face < face_count; ++face) {
      report_now_and_then(face, face_count, 0.5, 0.7);
      const auto left = static_cast<std::size_t>(end_ - at_);
      if (left < fixed) fail_truncated(face, face_count);
      const auto size = static_cast<std::int64_t>(load<Count, Order>(at_ + layout.before));
      if (size < 3) {
        fail(at_, ErrorCode::BadFile,
             "face " + std::to_string(face) + " has " + std::to_string(size) +
                 " corners, a face needs 3 or more; remove it");
      }
      if ((left - fixed) / index_bytes < static_cast<std::size_t>(size)) fail_truncated(face, face_count);
      corners += static_cast<std::size_t>(size);
      if (corners >= static_cast<std::size_t>(std::numeric_limits<Index>::max())) {
        require_index_count(source_.name, corners, "face corners");
      }
      mesh_.face_offsets[face + 1] = static_cast<Index>(corners);
      at_ += fixed + static_cast<std::size_t>(size) * index_bytes;
    }
  }

  [[noreturn]] void fail_truncated(std::size_t face, std::size_t face_count) const {
    fail(at_, ErrorCode::BadFile,
         "the file ends inside face " + std::to_string(face) + " of the " + std::to_string(face_count) +
             " that the header promises; it is cut short");
  }

  template <typename Number>
  void copy_corners(const FaceLayout& layout, const char* first, Index vertex_count) {
    const std::size_t fixed = layout.before + byte_size(layout.count_type) + layout.after;
    const Buffer<Index>& offsets = mesh_.face_offsets;
    const std::ptrdiff_t face_count = mesh_.face_count();
    const auto copy_block = [&](std::size_t block) {
      const std::ptrdiff_t begin = static_cast<std::ptrdiff_t>(block) * kDefaultBlock;
      const std::ptrdiff_t end = std::min(begin + kDefaultBlock, face_count);
      for (std::ptrdiff_t face = begin; face < end; ++face) {
        const char* corners = first + fixed * static_cast<std::size_t>(face) + layout.before +
                              byte_size(layout.count_type) + sizeof(Number) * static_cast<std::size_t>(offsets[face]);
        for (Index corner = offsets[face]; corner < offsets[face + 1]; ++corner, corners += sizeof(Number)) {
          const auto vertex = static_cast<std::int64_t>(load<Number, Order>(corners));
          if (vertex < 0 || vertex >= vertex_count) {
            fail(corners, ErrorCode::IndexOutOfRange,
                 "face " + std::to_string(face) + " names vertex " + std::to_string(vertex) + ", but there are " +
                     std::to_string(vertex_count) + ", counted from 0");
          }
          mesh_.face_vertices[corner] = static_cast<Index>(vertex);
        }
      }
    };
    for_each_chunk(static_cast<std::size_t>(block_count(face_count)), copy_block,
                   progress_within(source_.progress, 0.7, 1.0));
  }

  /// Reads rows of any size one by one: those with several lists, those of strips, or vertices with
  /// lists.
  void read_rows(const PlyTargets& targets) {
    std::vector<PlyFaces> faces(1);
    BinaryValues<Order> values{at_, end_};
    for (std::size_t row = 0; row < targets.element->count; ++row) {
      report_now_and_then(row, targets.element->count, 0.0, 1.0);
      read_ply_row(values, targets, static_cast<std::ptrdiff_t>(row), faces[0]);
    }
    at_ = values.at;
    faces_.join(source_.name, faces, mesh_);
  }

  const Source& source_;
  const char* at_;
  const char* end_;
  PlyFaceValues& faces_;
  Mesh& mesh_;
};

template <ByteOrder Order>
void read_elements(const Source& source, const PlyHeader& header, std::vector<PlyTargets>& targets,
                   PlyFaceValues& faces, Mesh& mesh) {
  BinaryReader<Order> reader(source, header, faces, mesh);
  for (PlyTargets& target : targets) reader.read(target);
}

}  // namespace

void read_ply_binary(const Source& source, const PlyHeader& header, std::vector<PlyTargets>& targets,
                     PlyFaceValues& faces, Mesh& mesh) {
  if (header.encoding == PlyEncoding::BigEndian) {
    read_elements<ByteOrder::Big>(source, header, targets, faces, mesh);
  } else {
    read_elements<ByteOrder::Little>(source, header, targets, faces, mesh);
  }
}

}  // namespace batten::io
