/// \file Which way is up: the axes of a mesh as it stands, and a guess from its shape.
#pragma once
#include <Eigen/Core>

#include "batten/mesh/mesh.h"

namespace batten {

/// The direction that points up. Auto stands for guess_up_axis.
enum class UpAxis { Auto, X, Y, Z, MinusX, MinusY, MinusZ };

/// The right, the back and the top of a mesh, as unit vectors along its axes. The eye of the front view looks along
/// `back`. Right x back = up.
struct UpFrame {
  Eigen::Vector3d right;
  Eigen::Vector3d back;
  Eigen::Vector3d up;
};

/// With Z up, the front is at -y (3-D printing, CAD, Blender); with Y up, at +z (glTF, USD, Maya). X: as Z with the
/// axes turned cyclically, the front at -z. With a minus, the mesh stands on its head: its left and right are as
/// without it and its front is at the other end. Auto is not allowed.
UpFrame up_frame(UpAxis up);

/// The matrix whose product with a point (as a column) has y up and the front at +z, as glTF and USD want it. Its
/// entries are 0, 1 and -1, and it is the identity for Y, so products are exact.
Eigen::Matrix3d to_y_up(UpAxis up);

/// How steadily the points stand with this axis up: the area of the hull of everything near the bottom as a share of
/// that of the floor plan, or 0 if the centre of the points is not above it. O(n log n).
double steadiness(const Points& points, UpAxis up);

/// Z or Y: `usual`, unless the mesh stands well on the other of the two and at least half as steadily again as on the
/// usual one. Looks at 50,000 corners of faces at most, and at points where there is no face. `usual` is Y or Z.
UpAxis guess_up_axis(const Mesh& mesh, UpAxis usual = UpAxis::Z);

}  // namespace batten
