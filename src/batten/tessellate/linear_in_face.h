/// \file Values at the corners of a face at a place in it: linear on a triangle, bilinear on a quad.
#pragma once

namespace batten {

/// row = the value at (u, v); corner(i) gives the row of values at corner i.
template <typename Row, typename Corner>
void set_linear(bool quad, double u, double v, const Corner& corner, Row&& row) {
  if (quad) {
    row = (1.0 - v) * ((1.0 - u) * corner(0) + u * corner(1)) + v * (u * corner(2) + (1.0 - u) * corner(3));
  } else {
    row = (1.0 - u - v) * corner(0) + u * corner(1) + v * corner(2);
  }
}

}  // namespace batten
