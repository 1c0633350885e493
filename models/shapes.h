/// \file The sample models: small control meshes that are worth a picture, made of formulas.
///
/// z is up, the front is -y. Every model is an orientable 2-manifold, faces counter-clockwise seen from outside.
/// Vertices are samples of the shape that is meant, so that a surface that passes through them is that shape.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten::models {

Mesh pipe_joint();    ///< two crossing pipes with a fillet, four open ends; 8 vertices of valence 5
Mesh coarse_joint();  ///< the same of as few triangles as show it, 8 around each pipe; valences 4 to 7
Mesh tripod();        ///< three legs that meet in a hub; closed
Mesh torus_knot();    ///< a tube along a trefoil, 72 by 8; closed
Mesh bracket();       ///< an angle bracket with a rib and four bolt holes; creases of 10 and of 2.5
Mesh creature();      ///< a body, four legs, a head with a snout and ears, a tail; closed
Mesh pyramid();       ///< five vertices, six triangles: a square pyramid, taller than wide

/// The bracket refined twice, its creases untold, with noise: what a scanner makes of it.
Mesh bracket_scan();

/// The same faces around a sphere, evenly spread as far as they can be: what a closed mesh of genus 0 morphs into.
Mesh ball_of(const Mesh& mesh, double radius);

/// The tripod as a bad export may leave it: legs that share no vertices, one inside out; a fin on another; a face
/// twice, a face without area, a vertex without a face.
Mesh broken_tripod(const Mesh& tripod);

struct Model {
  std::string name;
  Mesh mesh;
};

/// All of them and the regular solids, with coordinates rounded so that files stay small.
std::vector<Model> all_models();

/// Other shapes of the same faces, for `batten morph`.
std::vector<Model> morph_models();

/// Those that no surface can be made of, for `batten repair`.
std::vector<Model> broken_models();

/// The distance to a shape's surface, negative inside: exact or a little less.
using Field = std::function<double(const Eigen::Vector3d&)>;

/// min(a, b) with a fillet about as wide as `width` where they are close (Quilez's quadratic).
double blend(double a, double b, double width);

/// From the origin of the ray, which is inside, outwards to the surface.
Eigen::Vector3d cast(const Field& field, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

/// Down or up the gradient, onto the surface.
Eigen::Vector3d settle(const Field& field, Eigen::Vector3d point);

}  // namespace batten::models
