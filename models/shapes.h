/// \file The sample models: small control meshes computed from formulas.
///
/// z is up, the front is -y. Every model is an orientable 2-manifold with faces counter-clockwise seen from outside.
/// The vertices are points of the intended shape, so that a surface through them approximates it.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "batten/medial/medial_model.h"
#include "batten/mesh/mesh.h"

namespace batten::models {

Mesh pipe_joint();    ///< two crossing pipes with a fillet, four open ends; 8 vertices of valence 5
Mesh coarse_joint();  ///< the same joint with few triangles, 8 around each pipe; valences 4 to 7
Mesh tripod();        ///< three legs that meet in a hub; closed
Mesh torus_knot();    ///< a tube along a trefoil, 72 by 8; closed
Mesh bracket();       ///< an angle bracket with a rib and four bolt holes; creases of 10 and of 2.5
Mesh creature();      ///< a body, four legs, a head with a snout and ears, a tail; closed
Mesh ring();          ///< a lumpy ring with colours at the vertices and a texture whose seams go around both ways
Mesh pyramid();       ///< five vertices, six triangles: a square pyramid, taller than wide
Mesh lifted_grid();   ///< 8 by 8 quads in a plane, the vertex in the middle lifted

/// A cube with one corner pushed in: no Catmull-Clark surface passes through its points.
Mesh dented_cube();

/// The bracket refined twice, without creases and with noise, like a scan.
Mesh bracket_scan();

/// Moves every coordinate by approximately normal noise, the same on every machine.
void add_noise(Points& points, double deviation);

/// The same faces on a sphere, spread as evenly as possible: the target of morphs of closed meshes of genus 0.
Mesh ball_of(const Mesh& mesh, double radius);

/// The tripod with typical faults of an export: legs that share no vertices, one of them inside out; a fin on another;
/// a repeated face, a face without area, a vertex without a face.
Mesh broken_tripod(const Mesh& tripod);

/// Points of the tripod's limit surface with noise, like a scan whose three strips share no vertices; one strip is
/// inside out, a face is repeated, a vertex has no face.
Mesh tripod_scan(const Mesh& tripod);

struct Model {
  std::string name;
  Mesh mesh;
};

/// All models and the regular solids, with coordinates rounded so that files stay small.
std::vector<Model> all_models();

/// Other shapes of the creature's faces: a ball for `batten morph`; one point of the forehead pulled out for
/// `batten interpolate --from`.
std::vector<Model> morph_models();

/// Meshes without a surface, for `batten repair`.
std::vector<Model> broken_models();

/// For `batten simulate`: a sphere of 98 vertices, an upright flag, a crowned panel, and that panel with a dent.
std::vector<Model> elastic_models();

MedialModel medial_slab();  ///< a bent plate, 5 by 8 atoms
MedialModel medial_tube();  ///< a strip along three quarters of a circle, thickest in its middle, 3 by 15 atoms
MedialModel medial_bean();  ///< an s-rep of 20 lines and 3 steps, bent like a kidney

/// A handle with two prongs at its end and a thumb on its upper side, joined by hinges: a closed surface.
MedialModel medial_fork();

/// A medial model and the file that holds it.
struct MedialSample {
  std::string file;
  MedialModel model;
};

/// For `batten medial`.
std::vector<MedialSample> medial_models();

/// The distance to a shape's surface or a little less, negative inside.
using Field = std::function<double(const Eigen::Vector3d&)>;

/// min(a, b) with a fillet about as wide as `width` where both are close (Quilez's quadratic).
double blend(double a, double b, double width);

/// The point where a ray from an origin inside reaches the surface.
Eigen::Vector3d cast(const Field& field, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

/// Moves a point along the gradient onto the surface.
Eigen::Vector3d settle(const Field& field, Eigen::Vector3d point);

}  // namespace batten::models
