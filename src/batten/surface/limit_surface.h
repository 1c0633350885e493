/// \file The limit surface as a thing to ask: point, derivatives and curvature anywhere.
///
/// A place is a face of the base (patch/surface_patches.h) and (u, v) in it. In a quad u runs from its first corner to
/// its second, v to its fourth, both in [0, 1]; in a triangle to its second and third, with u + v <= 1. Derivatives are
/// by these.
///
/// Exact everywhere: a face between regular vertices is a polynomial; next to others the face is halved towards the
/// place until it is, by the subdivision of its one-ring (after Stam 1998, key S98), and at an extraordinary vertex
/// itself the point and the tangent plane have closed forms.
#pragma once
#include <memory>
#include <span>

#include "batten/patch/surface_patches.h"
#include "batten/patch/surface_place.h"

namespace batten {

/// Throws Error(IndexOutOfRange, BadArgument) for a face or parameters that do not exist. base: of quads or triangles.
void require_place(const Topology& base, const SurfacePlace& place);

/// Point and derivatives. At a vertex that is not regular, and on it only, du and dv span the tangent plane (du x dv
/// points outward) but are no derivatives, and there are no second ones: then `regular` is false and they are zero.
struct Jet {
  Eigen::Vector3d point, du, dv, duu, duv, dvv;
  bool regular = true;
};

/// By the first and second fundamental forms. Curvatures are positive where the surface bends towards its normal's far
/// side, as on a sphere with its normals outward, in 1/unit; directions are unit vectors.
struct PointCurvature {
  Eigen::Vector3d normal;  ///< unit, outward for counter-clockwise faces; zero where du and dv are parallel
  double mean = 0.0;
  double gaussian = 0.0;
  double greatest = 0.0;  ///< principal curvatures, greatest >= least
  double least = 0.0;
  Eigen::Vector3d greatest_direction;
  Eigen::Vector3d least_direction;
};
/// All numbers but the normal are NaN where the jet has no second derivatives or no normal.
PointCurvature curvature_of(const Jet& jet);

/// Built for a connectivity and control points; asking is const and safe from several threads. Build O(H), 0.2 to 3
/// microseconds a face. A jet costs 20 to 30 ns on regular faces, 20 to 60 more next to irregular vertices, and some 40
/// for every five halvings beyond those that are kept: up to 3 kB for each vertex of the base, eight halvings where a
/// tenth of the faces are irregular, two where all are (docs/decisions/008-jets.md).
class LimitSurface {
 public:
  /// control: V-by-3. Throws Error(NotTriangles, BadArgument, BadShape, NotFinite, Cancelled),
  /// and Error(TooLarge) as SurfacePatches::pieces() does.
  LimitSurface(const SurfacePatches& patches, ConstValuesRef control, const Progress& progress = {});
  LimitSurface(const Topology& topology, const Scheme& scheme, ConstValuesRef control, const Progress& progress = {});
  ~LimitSurface();
  LimitSurface(LimitSurface&&) noexcept;

  const SurfacePatches& patches() const;
  const Topology& base() const { return patches().base(); }

  /// Throws Error(IndexOutOfRange, BadArgument) for a face or parameters that do not exist.
  Jet jet(const SurfacePlace& place) const;
  /// jets[i] for places[i], threaded. Throws the same, and Error(BadShape) where the sizes differ.
  void jets(std::span<const SurfacePlace> places, std::span<Jet> jets) const;

  /// The same for other control points: connectivity is kept. Throws Error(BadShape, NotFinite, Cancelled), and then
  /// changes nothing.
  void set_control(ConstValuesRef control, const Progress& progress = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten
