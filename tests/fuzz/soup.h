/// \file Bytes to small polygon soups, for the fuzz target of everything that computes.
#pragma once
#include <cstddef>
#include <cstdint>

#include "batten/mesh/mesh.h"
#include "batten/scheme/scheme.h"

namespace batten::fuzz {

/// What a few bytes describe.
struct Soup {
  Mesh mesh;          ///< a shape with faces taken away, faces of any vertices added, points moved, tags
  double alpha = 0;   ///< Lai's
  int cancel_at = 0;  ///< the call of the progress callback that cancels; 0: none does
};

/// Takes byte after byte; zeros where there are no more.
Soup decode_soup(const std::uint8_t* data, std::size_t size);

}  // namespace batten::fuzz
