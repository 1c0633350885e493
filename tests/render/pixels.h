/// \file Small scenes and ways to look at a picture.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "batten/mesh/primitives.h"
#include "batten/render/render.h"
#include "support/errors.h"

namespace batten::test {

using Pixel = std::array<int, 3>;

inline Pixel pixel(const Picture& picture, int x, int y) {
  const std::size_t at =
      static_cast<std::size_t>(picture.channels) *
      (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x));
  return {picture.pixels[at], picture.pixels[at + 1], picture.pixels[at + 2]};
}

inline int brightness(const Pixel& p) { return p[0] + p[1] + p[2]; }

inline int different_pixels(const Picture& a, const Picture& b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) count += pixel(a, x, y) != pixel(b, x, y) ? 1 : 0;
  }
  return count;
}

/// Rings of quads between two fans, radius 1.
inline Mesh sphere(Index around, Index down) {
  Mesh mesh;
  mesh.points.resize(around * (down - 1) + 2, 3);
  for (Index j = 1; j < down; ++j) {
    const double polar = std::numbers::pi * j / down;
    for (Index i = 0; i < around; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / around;
      mesh.points.row((j - 1) * around + i) << std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
          std::cos(polar);
    }
  }
  const Index top = around * (down - 1);
  mesh.points.row(top) << 0, 0, 1;
  mesh.points.row(top + 1) << 0, 0, -1;
  for (Index i = 0; i < around; ++i) {
    const Index next = (i + 1) % around;
    mesh.add_face({top, i, next});
    for (Index j = 0; j + 2 < down; ++j)
      mesh.add_face({j * around + i, (j + 1) * around + i, (j + 1) * around + next, j * around + next});
    mesh.add_face({top + 1, (down - 2) * around + next, (down - 2) * around + i});
  }
  return mesh;
}

inline Scene sphere_scene() {
  Scene scene;
  scene.surface = sphere(96, 48);
  return scene;
}

/// From the front, at the height of the centre.
inline RenderOptions small_front_view() {
  RenderOptions options;
  options.width = 240;
  options.height = 180;
  options.up = UpAxis::Z;
  options.direction = {0.0, -1.0, 0.0};
  return options;
}

}  // namespace batten::test
