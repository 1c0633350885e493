/// \file Checks and sentences that forces share.
#pragma once
#include <Eigen/Core>
#include <string>

#include "batten/error.h"
#include "batten/patch/surface_place.h"

namespace batten {

/// "face 3 at (0.25, 0.5)".
std::string describe(const SurfacePlace& place);
/// "(1, 0.5, -2)".
std::string describe(const Eigen::Vector3d& vector);

/// The Error(NotFinite) that says so of `what`.
Error not_finite(const Eigen::Vector3d& vector, const std::string& what);

/// `what` begins the sentence, as "the stiffness of spring 3". Throws Error(NotFinite).
void require_finite_number(double number, const std::string& what);
void require_finite_vector(const Eigen::Vector3d& vector, const std::string& what);
/// Throws also Error(BadArgument).
void require_not_negative(double number, const std::string& what);

}  // namespace batten
