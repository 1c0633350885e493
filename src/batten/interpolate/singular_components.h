/// \file Components on which interpolation may fail, recognised before solving.
#pragma once
#include "batten/limit/limit_matrix.h"

namespace batten {

/// A closed component of smooth vertices, all of valence 3, whose edges are two-colourable: its block of the
/// Catmull-Clark system has the null vector sign.
struct SingularComponent {
  Buffer<Index> vertices;
  Buffer<std::int8_t> sign;  ///< +1 or -1, per entry of vertices
};

/// O(V); empty under Loop and where alpha > 0.
std::vector<SingularComponent> find_singular_components(const LimitMatrix& matrix);

/// True where one of the vertices is smooth and of valence 2: the component's system may be indefinite.
bool has_valence_two(const LimitMatrix& matrix, const Buffer<Index>& vertices);

}  // namespace batten
