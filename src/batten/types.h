/// \file Types that every room uses: indices, values, and the choices about its surface that a mesh file can hold.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>

namespace batten {

/// An index or a count of vertices, faces, half-edges and other elements.
using Index = std::int32_t;

/// An N-by-k matrix whose row i belongs to element i. All linear operators take it; positions have k = 3. DontAlign
/// makes its memory come from malloc, whatever instruction set a program and the library were compiled for, so that
/// each may free what the other allocated.
using Values = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor | Eigen::DontAlign>;
/// N-by-3, with the same layout.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor | Eigen::DontAlign>;
/// N numbers, one for each element.
using Scalars = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor | Eigen::DontAlign>;
/// k numbers, as in a row of Values.
using ValueRow = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor | Eigen::DontAlign>;
/// A parameter type that binds to Values, to Points and to blocks of rows or columns without a copy.
using ConstValuesRef = const Eigen::Ref<const Values, 0, Eigen::OuterStride<>>&;
/// The same for values that are written.
using ValuesRef = Eigen::Ref<Values, 0, Eigen::OuterStride<>>;

/// Catmull-Clark takes faces of any size, the other schemes take triangles. The surfaces of Catmull-Clark and Loop
/// approximate their control points; those of the two Butterflies pass through them.
enum class SchemeKind {
  CatmullClark,
  Loop,
  Butterfly,         ///< Dyn, Gregory and Levin's, one stencil for all edges: smooth at valences 4 to 7 only
  ModifiedButterfly  ///< Zorin, Schroeder and Sweldens': smooth at every valence
};

/// True where the limit surface passes through the control points: for the two Butterflies. Their semi-sharp creases
/// last for as many levels as their sharpness says, rounded up, under either CreaseMethod.
constexpr bool is_interpolating(SchemeKind kind) {
  return kind == SchemeKind::Butterfly || kind == SchemeKind::ModifiedButterfly;
}

/// How the Butterfly schemes make points beside a boundary or a crease.
enum class ButterflyBoundary {
  CreaseRules,  ///< special rules, exact for quadratic polynomials (at extraordinary boundary vertices for linear ones)
  Reflect       ///< the paper's rule: points beyond the boundary by reflection; exact for linear polynomials
};

/// What the surface does at a boundary (OpenSubdiv's names).
enum class BoundaryRule {
  None,           ///< faces at the boundary shape the surface but are not part of it
  EdgeAndCorner,  ///< boundaries are curves; vertices of a single face keep their position
  EdgeOnly        ///< boundaries are curves, which are smooth at vertices of a single face too
};

/// How semi-sharp sharpness decays from level to level.
enum class CreaseMethod { Uniform, Chaikin };

/// Which weights a Catmull-Clark edge point takes beside triangles.
enum class TriangleRule { Catmark, Smooth };

/// Where values at corners, such as texture coordinates, are linear (OpenSubdiv's names). An edge across which they
/// differ is a seam. All makes them linear within every face. The others smooth them as the scheme smooths points, and
/// seams and boundaries as it smooths boundary curves, but for what each keeps as it is.
enum class FaceVaryingRule {
  None,          ///< keeps nothing: seams are curves everywhere
  CornersOnly,   ///< corners: where one face alone has a value
  CornersPlus1,  ///< and vertices where three or more pieces meet, or one of two pieces has a sharp edge inside
  CornersPlus2,  ///< and the ends of seams, and both values where one of two pieces has a corner
  Boundaries,    ///< all seams and boundaries, which are linear
  All            ///< everything
};

/// How refinement carries values at the vertices.
enum class CarryRule {
  Scheme,   ///< by the scheme's masks, as it carries points: smooth, but an approximation of the values
  Midpoint  ///< linearly: the values stay, edges and faces get the mean of theirs; continuous, within their range
};

/// A sharpness of 10 or more is infinite, as in OpenSubdiv.
inline constexpr float kInfiniteSharpness = 10.0F;

/// A callback that an operation calls now and then with the completed fraction in [0, 1], from the thread that called
/// the operation. If it returns false, the operation throws Error(Cancelled) within a fraction of a second.
using Progress = std::function<bool(double)>;

}  // namespace batten
