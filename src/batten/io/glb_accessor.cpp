#include "batten/io/glb_accessor.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "batten/error.h"
#include "batten/io/bytes.h"

namespace batten::io {

namespace {

/// Numbers in a buffer, at equal distances.
struct Numbers {
  const char* first;
  std::size_t stride;
  int type;
  bool normalized;

  double at(std::size_t row, int column) const {
    const char* begin = first + row * stride;
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return fraction(load<std::int8_t, ByteOrder::Little>(begin + column));
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return fraction(load<std::uint8_t, ByteOrder::Little>(begin + column));
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return fraction(load<std::int16_t, ByteOrder::Little>(begin + 2 * column));
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return fraction(load<std::uint16_t, ByteOrder::Little>(begin + 2 * column));
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return fraction(load<std::uint32_t, ByteOrder::Little>(begin + 4 * column));
      default:
        return double{load<float, ByteOrder::Little>(begin + 4 * column)};
    }
  }

 private:
  template <typename Integer>
  double fraction(Integer value) const {
    if (!normalized) return value;
    return std::max(-1.0, static_cast<double>(value) / static_cast<double>(std::numeric_limits<Integer>::max()));
  }
};

class AccessorReader {
 public:
  AccessorReader(const std::string& name, const tinygltf::Model& model) : name_(name), model_(model) {}

  Values read(int index, int columns) const {
    const tinygltf::Accessor& accessor = element(model_.accessors, index, "accessor");
    const int found = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (found < 1 || found > 4 || (columns > 0 && found != columns)) fail("an accessor has an unexpected type");
    require_rows(accessor.count);
    Values values = Values::Zero(static_cast<Eigen::Index>(accessor.count), found);
    if (accessor.bufferView >= 0) {
      const Numbers numbers = find(accessor.bufferView, accessor.byteOffset, accessor.count, found,
                                   accessor.componentType, accessor.normalized);
      for (Eigen::Index row = 0; row < values.rows(); ++row) {
        for (int k = 0; k < found; ++k) values(row, k) = numbers.at(static_cast<std::size_t>(row), k);
      }
    }
    if (accessor.sparse.isSparse) replace_sparse(accessor, values);
    return values;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(ErrorCode::BadFile, name_ + ": " + what); }

  template <typename Element>
  const Element& element(const std::vector<Element>& all, int index, const char* what) const {
    if (index < 0 || static_cast<std::size_t>(index) >= all.size()) fail(std::string("there is no such ") + what);
    return all[static_cast<std::size_t>(index)];
  }

  /// A count that the file has no bytes for is refused before memory is allocated, also where all rows are zero.
  void require_rows(std::size_t count) const {
    std::size_t bytes = 0;
    for (const tinygltf::Buffer& buffer : model_.buffers) bytes += buffer.data.size();
    if (count > bytes) fail("an accessor promises " + std::to_string(count) + " rows, more than the file can hold");
  }

  Numbers find(int view_index, std::size_t offset, std::size_t count, int columns, int type, bool normalized) const {
    const tinygltf::BufferView& view = element(model_.bufferViews, view_index, "bufferView");
    const tinygltf::Buffer& buffer = element(model_.buffers, view.buffer, "buffer");
    const std::int32_t size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
    if (size != 1 && size != 2 && size != 4) fail("an accessor has an unknown component type");
    const std::size_t row_bytes = static_cast<std::size_t>(size) * static_cast<std::size_t>(columns);
    const std::size_t stride = view.byteStride > 0 ? view.byteStride : row_bytes;
    const std::size_t bytes = buffer.data.size();
    const bool view_fits = view.byteOffset <= bytes && view.byteLength <= bytes - view.byteOffset;
    const bool fits = view_fits && offset <= view.byteLength &&
                      (count == 0 || (row_bytes <= view.byteLength - offset &&
                                      count - 1 <= (view.byteLength - offset - row_bytes) / stride));
    if (!fits) fail("an accessor reaches beyond its buffer; the file is cut short or damaged");
    return {reinterpret_cast<const char*>(buffer.data.data()) + view.byteOffset + offset, stride, type, normalized};
  }

  void replace_sparse(const tinygltf::Accessor& accessor, Values& values) const {
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
      fail("a sparse accessor is damaged");
    const auto count = static_cast<std::size_t>(sparse.count);
    const int columns = static_cast<int>(values.cols());
    const Numbers rows = find(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count, 1,
                              sparse.indices.componentType, false);
    const Numbers given = find(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count,
                               columns, accessor.componentType, accessor.normalized);
    for (std::size_t i = 0; i < count; ++i) {
      const double row = rows.at(i, 0);
      if (!(row >= 0.0 && row < static_cast<double>(values.rows())))
        fail("a sparse accessor names a row that it has not");
      for (int k = 0; k < columns; ++k) values(static_cast<Eigen::Index>(row), k) = given.at(i, k);
    }
  }

  const std::string& name_;
  const tinygltf::Model& model_;
};

}  // namespace

Values read_accessor(const std::string& name, const tinygltf::Model& model, int accessor, int columns) {
  return AccessorReader(name, model).read(accessor, columns);
}

}  // namespace batten::io
