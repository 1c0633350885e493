#include "batten/io/glb_blocks.h"

namespace batten::io {

unsigned char* GlbBlocks::add_block(std::size_t bytes, int target, tinygltf::Accessor accessor) {
  std::vector<unsigned char>& data = model_.buffers[0].data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();
  view.byteLength = bytes;
  view.target = target;
  data.resize(data.size() + (bytes + 3) / 4 * 4);
  accessor.bufferView = static_cast<int>(model_.bufferViews.size());
  model_.bufferViews.push_back(view);
  model_.accessors.push_back(std::move(accessor));
  return data.data() + view.byteOffset;
}

void GlbBlocks::add_bounds(int accessor) {
  tinygltf::Accessor& bounded = model_.accessors[accessor];
  const unsigned char* bytes = model_.buffers[0].data.data() + model_.bufferViews[bounded.bufferView].byteOffset;
  Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::max());
  Eigen::Array3f high = -low;
  for (std::size_t i = 0; i < bounded.count; ++i) {
    Eigen::Array3f point;
    std::memcpy(point.data(), bytes + i * sizeof(point), sizeof(point));
    low = low.min(point);
    high = high.max(point);
  }
  for (int k = 0; k < 3; ++k) {
    bounded.minValues.push_back(low[k]);
    bounded.maxValues.push_back(high[k]);
  }
}

}  // namespace batten::io
