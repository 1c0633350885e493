#include "batten/energy/face_coefficients.h"

#include <cmath>

#include "batten/error.h"

namespace batten {

void require_coefficients(std::span<const double> coefficients, Index face_count, const std::string& name) {
  if (coefficients.size() != 1 && coefficients.size() != static_cast<std::size_t>(face_count)) {
    throw Error(ErrorCode::BadShape, "there are " + std::to_string(coefficients.size()) + " values of the " + name +
                                         ", but the mesh has " + std::to_string(face_count) +
                                         " faces; give one for all faces or one a face");
  }
  for (std::size_t f = 0; f < coefficients.size(); ++f) {
    if (!std::isfinite(coefficients[f])) {
      throw Error(ErrorCode::NotFinite, "the " + name + " of face " + std::to_string(f) + " is not finite");
    }
    if (coefficients[f] < 0.0) {
      throw Error(ErrorCode::BadArgument, "the " + name + " of face " + std::to_string(f) +
                                              " is negative; give zero or more, so that no energy is negative");
    }
  }
}

std::vector<double> child_coefficients(std::span<const double> coefficients, const Topology& parent, bool quads) {
  if (coefficients.size() == 1) return {coefficients.begin(), coefficients.end()};
  std::vector<double> result;
  for (Index f = 0; f < parent.face_count(); ++f) {
    const Index children = quads ? parent.face_size(f) : 4;
    result.insert(result.end(), static_cast<std::size_t>(children), coefficient_of(coefficients, f));
  }
  return result;
}

}  // namespace batten
