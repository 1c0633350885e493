/// \file The header of a PLY file.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batten/io/source.h"

namespace batten::io {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Int64, Uint64, Float32, Float64 };
enum class PlyEncoding { Text, LittleEndian, BigEndian };

struct PlyProperty {
  std::string name;
  PlyType type;                       ///< for a list, the type of its entries
  std::optional<PlyType> count_type;  ///< lists only

  bool is_list() const { return count_type.has_value(); }
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// The bytes of a row with empty lists.
  std::size_t smallest_row() const;
  bool has_list() const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::Text;
  std::vector<PlyElement> elements;
  std::vector<std::string> texture_files;  ///< of the lines `comment TextureFile NAME`
  const char* body = nullptr;
};

std::size_t byte_size(PlyType type);
bool is_integer(PlyType type);

/// Throws Fault.
PlyHeader parse_ply_header(const Source& source);

}  // namespace batten::io
