/// \file Places of a surface from arrays.
#pragma once
#include <vector>

#include "batten/patch/surface_place.h"
#include "native/arrays.h"

namespace batten::python {

/// n faces and (u, v) of shape (n, 2). Throws Error(BadShape).
inline std::vector<SurfacePlace> places_of(const Indices& faces, const Doubles& parameters) {
  const Eigen::Map<const Values> uv = rows_of(parameters, "(u, v)");
  if (uv.cols() != 2 || uv.rows() != faces.size() || faces.ndim() > 1) {
    throw Error(ErrorCode::BadShape, "places are n faces and (u, v) of shape (n, 2)");
  }
  std::vector<SurfacePlace> places;
  places.reserve(static_cast<std::size_t>(uv.rows()));
  for (Eigen::Index i = 0; i < uv.rows(); ++i) places.push_back({faces.data()[i], uv(i, 0), uv(i, 1)});
  return places;
}

}  // namespace batten::python
