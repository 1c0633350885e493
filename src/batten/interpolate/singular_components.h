/// \file Components on which interpolation may fail, recognised before solving.
#pragma once
#include "batten/limit/limit_matrix.h"

namespace batten {

/// A closed component of smooth vertices, all of valence 3, whose edges are two-colourable: its block of the
/// Catmull-Clark system has the null vector sign (MATH 2.2).
struct SingularComponent {
  Buffer<Index> vertices;
  Buffer<std::int8_t> sign;  ///< +1 or -1, per entry of vertices
};

/// O(V); empty under Loop and where alpha > 0.
std::vector<SingularComponent> find_singular_components(const LimitMatrix& matrix);

/// The vertices of closed components that have a smooth vertex of valence 2, where the system may be indefinite
/// (MATH 2.2). Empty, mostly. O(V).
Buffer<Index> find_valence_two_components(const LimitMatrix& matrix);

}  // namespace batten
