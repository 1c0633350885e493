/// \file The words that every room uses: indices, values, and the choices that a mesh file can make about its surface.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>

namespace batten {

/// Counts vertices, faces, half-edges and the rest.
using Index = std::int32_t;

/// N-by-k, row i belongs to element i. Everything linear works on these; positions are k = 3. DontAlign: their memory
/// comes from malloc, whatever a program and the library were compiled for, so that either may free what the other
/// made.
using Values = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor | Eigen::DontAlign>;
/// N-by-3, likewise.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor | Eigen::DontAlign>;
/// N numbers, one an element, likewise.
using Scalars = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor | Eigen::DontAlign>;
/// k numbers, as in a row of Values, likewise.
using ValueRow = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor | Eigen::DontAlign>;
/// A parameter type: binds to Values, to Points and to blocks of rows or columns without a copy.
using ConstValuesRef = const Eigen::Ref<const Values, 0, Eigen::OuterStride<>>&;
/// Likewise, to be written to.
using ValuesRef = Eigen::Ref<Values, 0, Eigen::OuterStride<>>;

/// Catmull-Clark takes faces of any size, the others triangles. The surfaces of the first two only follow their control
/// points; those of the other two pass through them.
enum class SchemeKind {
  CatmullClark,
  Loop,
  Butterfly,         ///< Dyn, Gregory and Levin's, the same stencil everywhere: smooth at valences 4 to 7 only
  ModifiedButterfly  ///< Zorin, Schroeder and Sweldens': smooth at every valence
};

/// True where the limit surface passes through the control points: the two Butterflies. Their semi-sharp creases last
/// for as many levels as their sharpness says, rounded up, under either CreaseMethod.
constexpr bool is_interpolating(SchemeKind kind) {
  return kind == SchemeKind::Butterfly || kind == SchemeKind::ModifiedButterfly;
}

/// How the Butterfly schemes make points beside a boundary or a crease.
enum class ButterflyBoundary {
  CreaseRules,  ///< rules of their own, exact for quadratic polynomials (at extraordinary boundary vertices linear
                ///< ones)
  Reflect       ///< the paper's: points beyond the boundary by reflection; exact for linear polynomials
};

/// What the surface does at a boundary (OpenSubdiv's names).
enum class BoundaryRule {
  None,           ///< faces at the boundary are not part of the surface; they only shape it
  EdgeAndCorner,  ///< boundary curves, and vertices of a single face stay where they are
  EdgeOnly        ///< boundary curves, smooth at vertices of a single face too
};

/// How semi-sharp sharpness decays from level to level.
enum class CreaseMethod { Uniform, Chaikin };

/// Which weights a Catmull-Clark edge point takes beside triangles.
enum class TriangleRule { Catmark, Smooth };

/// A sharpness of 10 or more is infinite, as in OpenSubdiv.
inline constexpr float kInfiniteSharpness = 10.0F;

/// Called now and then, by the thread that called the operation, with the done fraction in [0, 1]; return false to
/// cancel (the operation throws Error(Cancelled) within a fraction of a second).
using Progress = std::function<bool(double)>;

}  // namespace batten
