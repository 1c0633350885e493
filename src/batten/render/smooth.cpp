#include <algorithm>

#include "batten/parallel/parallel.h"
#include "batten/render/layers.h"

namespace batten::render_detail {
namespace {

enum class Direction { Across, Down };

struct Tap {
  int offset;
  float weight;
};

/// The sums of one row of pixels while neighbours are added.
struct RowSums {
  explicit RowSums(std::size_t width) : key(width), key_weight(width), sky(width), sky_weight(width) {}
  void clear() {
    for (auto* sums : {&key, &key_weight, &sky, &sky_weight}) std::fill(sums->begin(), sums->end(), 0.0F);
  }
  std::vector<float> key;
  std::vector<float> key_weight;
  std::vector<float> sky;
  std::vector<float> sky_weight;
};

/// The pixels of row y and their neighbours in row `other`, `shift` to the right.
struct Neighbours {
  int y;
  int other;
  int shift;
  float weight;
};

/// Adds neighbours weighted by closeness to the tangent plane and similarity of normals.
void add_shape(const Layers& layers, const Neighbours& n, float inverse_reach, RowSums& sums) {
  const float* nx = layers.row(Plane::NormalX, n.y);
  const float* ny = layers.row(Plane::NormalY, n.y);
  const float* nz = layers.row(Plane::NormalZ, n.y);
  const float* px = layers.row(Plane::PositionX, n.y);
  const float* py = layers.row(Plane::PositionY, n.y);
  const float* pz = layers.row(Plane::PositionZ, n.y);
  const float* mx = layers.row(Plane::NormalX, n.other) + n.shift;
  const float* my = layers.row(Plane::NormalY, n.other) + n.shift;
  const float* mz = layers.row(Plane::NormalZ, n.other) + n.shift;
  const float* qx = layers.row(Plane::PositionX, n.other) + n.shift;
  const float* qy = layers.row(Plane::PositionY, n.other) + n.shift;
  const float* qz = layers.row(Plane::PositionZ, n.other) + n.shift;
  const float* solid = layers.row(Plane::Solid, n.other) + n.shift;
  const float* key = layers.row(Plane::KeySeen, n.other) + n.shift;
  const float* key_weight = layers.row(Plane::KeyWeight, n.other) + n.shift;
  const float* sky = layers.row(Plane::SkySeen, n.other) + n.shift;
  const int begin = std::max(0, -n.shift);
  const int end = std::min(layers.width, layers.width - n.shift);
  float* key_sum = sums.key.data();
  float* key_weight_sum = sums.key_weight.data();
  float* sky_sum = sums.sky.data();
  float* sky_weight_sum = sums.sky_weight.data();
  for (int x = begin; x < end; ++x) {
    const float off = nx[x] * (qx[x] - px[x]) + ny[x] * (qy[x] - py[x]) + nz[x] * (qz[x] - pz[x]);
    const float far = off * off * inverse_reach * inverse_reach;
    const float near = far < 1.0F ? 1.0F - far : 0.0F;
    const float same = nx[x] * mx[x] + ny[x] * my[x] + nz[x] * mz[x];
    const float like = same > 0.0F ? same : 0.0F;
    const float like2 = like * like;
    const float like8 = like2 * like2 * like2 * like2;
    const float weight = n.weight * near * near * like8 * solid[x];
    const float key_part = weight * key_weight[x];
    key_sum[x] += key_part * key[x];
    key_weight_sum[x] += key_part;
    sky_sum[x] += weight * sky[x];
    sky_weight_sum[x] += weight;
  }
}

void add_ground(const Layers& layers, const Neighbours& n, RowSums& sums) {
  const float* ground = layers.row(Plane::GroundWeight, n.other) + n.shift;
  const float* key = layers.row(Plane::GroundKeySeen, n.other) + n.shift;
  const float* sky = layers.row(Plane::GroundSkySeen, n.other) + n.shift;
  const int begin = std::max(0, -n.shift);
  const int end = std::min(layers.width, layers.width - n.shift);
  float* key_sum = sums.key.data();
  float* sky_sum = sums.sky.data();
  float* weight_sum = sums.sky_weight.data();
  for (int x = begin; x < end; ++x) {
    const float weight = n.weight * ground[x];
    key_sum[x] += weight * key[x];
    sky_sum[x] += weight * sky[x];
    weight_sum[x] += weight;
  }
}

/// The second buffers of the planes that change.
struct Results {
  explicit Results(std::size_t size) : key(size), key_weight(size), sky(size), ground_key(size), ground_sky(size) {}
  Buffer<float> key;
  Buffer<float> key_weight;
  Buffer<float> sky;
  Buffer<float> ground_key;
  Buffer<float> ground_sky;
};

void divide(const std::vector<float>& sums, const std::vector<float>& weights, const float* old, float* out) {
  for (std::size_t x = 0; x < sums.size(); ++x) out[x] = weights[x] > 0.0F ? sums[x] / weights[x] : old[x];
}

template <typename AddTap>
void for_taps(const Layers& layers, int y, Direction direction, const std::vector<Tap>& taps, const AddTap& add) {
  for (const Tap& tap : taps) {
    const int other = direction == Direction::Down ? y + tap.offset : y;
    if (other < 0 || other >= layers.height) continue;
    add(Neighbours{y, other, direction == Direction::Across ? tap.offset : 0, tap.weight});
  }
}

void smooth_once(Layers& layers, Results& results, Direction direction, const std::vector<Tap>& taps, float reach) {
  const auto width = static_cast<std::size_t>(layers.width);
  parallel_for(
      layers.height,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        RowSums sums(width);
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
          const std::size_t start = static_cast<std::size_t>(y) * width;
          sums.clear();
          for_taps(layers, y, direction, taps, [&](const Neighbours& n) { add_shape(layers, n, 1.0F / reach, sums); });
          divide(sums.key, sums.key_weight, layers.row(Plane::KeySeen, y), &results.key[start]);
          divide(sums.sky, sums.sky_weight, layers.row(Plane::SkySeen, y), &results.sky[start]);
          // The next pass may use values that a pixel took from its neighbours.
          divide(sums.key_weight, sums.sky_weight, layers.row(Plane::KeyWeight, y), &results.key_weight[start]);
          sums.clear();
          for_taps(layers, y, direction, taps, [&](const Neighbours& n) { add_ground(layers, n, sums); });
          divide(sums.key, sums.sky_weight, layers.row(Plane::GroundKeySeen, y), &results.ground_key[start]);
          divide(sums.sky, sums.sky_weight, layers.row(Plane::GroundSkySeen, y), &results.ground_sky[start]);
        }
      },
      16);
  layers.plane(Plane::KeySeen).swap(results.key);
  layers.plane(Plane::KeyWeight).swap(results.key_weight);
  layers.plane(Plane::SkySeen).swap(results.sky);
  layers.plane(Plane::GroundKeySeen).swap(results.ground_key);
  layers.plane(Plane::GroundSkySeen).swap(results.ground_sky);
}

}  // namespace

void smooth_light(Layers& layers, float pixel) {
  // The end weights are halves: the width of four pixels, centred.
  const std::vector<Tap> box = {{-2, 0.5F}, {-1, 1.0F}, {0, 1.0F}, {1, 1.0F}, {2, 0.5F}};
  const std::vector<Tap> wide = {{-4, 0.5F}, {0, 1.0F}, {4, 0.5F}};
  Results results(layers.plane(Plane::KeySeen).size());
  for (const Direction direction : {Direction::Across, Direction::Down})
    smooth_once(layers, results, direction, box, 4.0F * pixel);
  for (const Direction direction : {Direction::Across, Direction::Down})
    smooth_once(layers, results, direction, wide, 6.0F * pixel);
}

}  // namespace batten::render_detail
