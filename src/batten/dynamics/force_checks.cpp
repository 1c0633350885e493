#include "batten/dynamics/force_checks.h"

#include <cmath>
#include <sstream>

namespace batten {

std::string describe(const SurfacePlace& place) {
  std::ostringstream text;
  text << "face " << place.face << " at (" << place.u << ", " << place.v << ")";
  return text.str();
}

std::string describe(const Eigen::Vector3d& vector) {
  std::ostringstream text;
  text << "(" << vector.x() << ", " << vector.y() << ", " << vector.z() << ")";
  return text.str();
}

Error not_finite(const Eigen::Vector3d& vector, const std::string& what) {
  return {ErrorCode::NotFinite, what + " is not finite: " + describe(vector)};
}

void require_finite_number(double number, const std::string& what) {
  if (!std::isfinite(number)) throw Error(ErrorCode::NotFinite, what + " is not finite");
}

void require_finite_vector(const Eigen::Vector3d& vector, const std::string& what) {
  if (!vector.allFinite()) throw not_finite(vector, what);
}

void require_not_negative(double number, const std::string& what) {
  require_finite_number(number, what);
  if (number >= 0.0) return;
  std::ostringstream text;
  text << what << " must be 0 or more, not " << number;
  throw Error(ErrorCode::BadArgument, text.str());
}

}  // namespace batten
