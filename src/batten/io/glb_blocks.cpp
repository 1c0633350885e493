#include "batten/io/glb_blocks.h"

namespace batten::io {

unsigned char* GlbBlocks::add_view(std::size_t bytes, int target) {
  std::vector<unsigned char>& data = model_.buffers[0].data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();
  view.byteLength = bytes;
  view.target = target;
  data.resize(data.size() + (bytes + 3) / 4 * 4);
  model_.bufferViews.push_back(view);
  return data.data() + view.byteOffset;
}

unsigned char* GlbBlocks::add_block(std::size_t bytes, int target, tinygltf::Accessor accessor) {
  accessor.bufferView = static_cast<int>(model_.bufferViews.size());
  model_.accessors.push_back(std::move(accessor));
  return add_view(bytes, target);
}

int GlbBlocks::add_bytes(std::string_view bytes) {
  std::memcpy(add_view(bytes.size(), 0), bytes.data(), bytes.size());
  return static_cast<int>(model_.bufferViews.size()) - 1;
}

int GlbBlocks::add_numbers(const double* numbers, std::ptrdiff_t count) {
  tinygltf::Accessor accessor;
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  accessor.type = TINYGLTF_TYPE_SCALAR;
  accessor.count = static_cast<std::size_t>(count);
  unsigned char* target = add_block(accessor.count * sizeof(float), 0, accessor);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto number = static_cast<float>(numbers[i]);
    std::memcpy(target + i * std::ptrdiff_t{sizeof(float)}, &number, sizeof(number));
  }
  return static_cast<int>(model_.accessors.size()) - 1;
}

void GlbBlocks::add_bounds(int accessor, int components) {
  tinygltf::Accessor& bounded = model_.accessors[accessor];
  const unsigned char* bytes = model_.buffers[0].data.data() + model_.bufferViews[bounded.bufferView].byteOffset;
  Eigen::ArrayXf low = Eigen::ArrayXf::Constant(components, std::numeric_limits<float>::max());
  Eigen::ArrayXf high = -low;
  Eigen::ArrayXf point(components);
  const std::size_t size = static_cast<std::size_t>(components) * sizeof(float);
  for (std::size_t i = 0; i < bounded.count; ++i) {
    std::memcpy(point.data(), bytes + i * size, size);
    low = low.min(point);
    high = high.max(point);
  }
  bounded.minValues.assign(low.begin(), low.end());
  bounded.maxValues.assign(high.begin(), high.end());
}

}  // namespace batten::io
