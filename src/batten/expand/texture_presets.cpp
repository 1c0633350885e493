#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/expand/texture.h"

namespace batten {
namespace {

using Place = Eigen::Vector3d;

/// A colour 0xRRGGBB in sRGB.
std::array<double, 3> hex(unsigned color) {
  constexpr double kWhite = 255.0;
  return {(color >> 16U & 255U) / kWhite, (color >> 8U & 255U) / kWhite, (color & 255U) / kWhite};
}

ColorRamp ramp(std::initializer_list<unsigned> colors) {
  std::vector<std::array<double, 3>> list;
  for (const unsigned color : colors) list.push_back(hex(color));
  return ColorRamp(list);
}

/// 0 below a, 1 above b, and smooth between them.
double smooth_step(double a, double b, double x) {
  const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Dark veins where the noise changes its sign, on a pale ground with clouds.
Texture marble() {
  const NoiseOptions veins{11, 3.6, 7, 0.5, Place(1.8, 1.0, 1.0)};
  const NoiseOptions clouds{12, 3.0, 4, 0.5};
  const NoiseOptions fine{13, 8.0, 5, 0.5, Place(1.8, 1.0, 1.0)};
  return {{veins, clouds, fine},
          [](const Place& /*place*/, const double* n) {
            const double broad = std::exp(-std::abs(n[0]) * 6.0) * (0.45 + 0.55 * smooth_step(-1.0, 1.0, n[1]));
            const double thin = 0.6 * std::exp(-std::abs(n[2]) * 12.0) * smooth_step(-0.9, 1.2, -n[1]);
            return std::max(broad, thin) + 0.07 * (n[1] + 1.5);
          },
          ramp({0xf6f4f1, 0xe4e3e2, 0xbfc0c3, 0x8d9198, 0x555b66, 0x2c323d})};
}

/// Annual rings around an axis beside the shape, with fibres along it.
Texture wood() {
  const NoiseOptions bend{21, 1.8, 3, 0.4, Place(3.0, 1.0, 1.0)};
  const NoiseOptions fibre{22, 70.0, 2, 0.7, Place(30.0, 1.0, 1.0)};
  return {{bend, fibre},
          [](const Place& place, const double* n) {
            constexpr double kRings = 15.0;  // per feature of the first noise
            constexpr double kTilt = 0.14;
            const double radius =
                std::hypot(place.y() + 0.22 + kTilt * place.x(), place.z() + 0.34 - kTilt * place.x()) + 0.035 * n[0];
            const double ring = kRings * radius;
            const double year = ring - std::floor(ring);
            // Early wood is pale and darkens slowly; late wood ends abruptly.
            const double late = std::pow(year, 2.5) * (1.0 - smooth_step(0.9, 1.0, year));
            return 0.2 + 0.62 * late + 0.1 * n[1];
          },
          ramp({0xdcb98a, 0xc99e6b, 0xad7a48, 0x8a5730, 0x633a1f})};
}

/// Grains of feldspar, quartz and mica.
Texture granite() {
  const NoiseOptions grains{31, 50.0, 3, 0.8};
  const NoiseOptions kinds{32, 36.0, 2, 0.7};
  const NoiseOptions mica{33, 60.0, 2, 0.8};
  return {{grains, kinds, mica},
          [](const Place& /*place*/, const double* n) {
            const double feldspar = smooth_step(0.1, 0.45, n[1]);
            const double base = 0.46 + 0.11 * n[0] + 0.30 * feldspar;
            const double dark = smooth_step(0.7, 1.1, n[2]);
            return base * (1.0 - dark) + 0.03 * dark;
          },
          ramp({0x16171a, 0x4a4a4d, 0x86868a, 0xb3aeab, 0xcfa898, 0xdcc3b4, 0xf0ebe4})};
}

/// Steel with patches of rust.
Texture rust() {
  const NoiseOptions patches{41, 3.6, 6, 0.62};
  const NoiseOptions pits{42, 22.0, 4, 0.7};
  return {{patches, pits},
          [](const Place& /*place*/, const double* n) {
            const double eaten = smooth_step(-0.55, 0.15, n[0] + 0.18 * n[1]);
            const double steel = 0.06 + 0.012 * n[1];
            const double oxide = 0.62 + 0.16 * n[0] + 0.12 * n[1];
            return steel + (std::clamp(oxide, 0.3, 1.0) - steel) * eaten;
          },
          ramp({0x8c9398, 0x7d7f7f, 0x7a4a2c, 0xb5622a, 0xc0692c, 0x8a4320, 0x56291a, 0x3a1d15})};
}

/// White on blue.
Texture clouds() {
  const NoiseOptions heaps{51, 4.0, 7, 0.52};
  return {{heaps},
          [](const Place& /*place*/, const double* n) { return smooth_step(-1.1, 1.7, n[0]); },
          ramp({0x2f6fb8, 0x4a87c9, 0x86b2de, 0xd4e3f1, 0xfbfcfd, 0xffffff})};
}

Texture preset_of(TexturePreset preset) {
  switch (preset) {
    case TexturePreset::Marble:
      return marble();
    case TexturePreset::Wood:
      return wood();
    case TexturePreset::Granite:
      return granite();
    case TexturePreset::Rust:
      return rust();
    case TexturePreset::Clouds:
      break;
  }
  return clouds();
}

}  // namespace

Texture preset_texture(TexturePreset preset, const PresetOptions& options) {
  Texture texture = preset_of(preset);
  NoiseOptions& first = texture.noises.front();
  const double scale = options.frequency > 0.0 ? options.frequency / first.frequency : 1.0;
  if (options.octaves > 0) first.octaves = options.octaves;
  if (options.gain >= 0.0) first.gain = options.gain;
  for (NoiseOptions& noise : texture.noises) {
    noise.frequency *= scale;
    // With seed + 1, textures of neighbouring seeds would share noises.
    noise.seed = options.seed * 0x9e3779b97f4a7c15ULL + noise.seed;
  }
  return texture;
}

}  // namespace batten
