/// \file Small shapes as meshes: the five regular solids, a torus and a grid.
///
/// All are centred on the origin. Faces are counter-clockwise seen from outside (the grid's, seen from above).
#pragma once
#include "batten/mesh/mesh.h"

namespace batten {

Mesh tetrahedron();   ///< 4 of the cube's vertices; circumradius sqrt(3)
Mesh cube();          ///< [-1, 1]^3; circumradius sqrt(3)
Mesh octahedron();    ///< the unit vectors; circumradius 1
Mesh icosahedron();   ///< (0, +-1, +-phi), permuted cyclically; edges of length 2, circumradius sqrt(phi + 2) = 1.902
Mesh dodecahedron();  ///< (+-1, +-1, +-1), and (0, +-1/phi, +-phi) permuted cyclically; circumradius sqrt(3)

/// A torus of quads around the z axis. Vertex i * across + j is at the angle 2 pi i / around along the circle of
/// `radius` and at 2 pi j / across in the tube, counted from the outer equator upwards. Throws Error(BadArgument)
/// unless around and across are 3 or more and 0 < tube_radius < radius.
Mesh torus(Index around, Index across, double radius = 1.0, double tube_radius = 0.4);

/// An open grid of nx by ny quads over [-1, 1]^2 at z = 0. Vertex j * (nx + 1) + i is the i-th along x and the j-th
/// along y. Throws Error(BadArgument) unless nx and ny are 1 or more.
Mesh grid(Index nx, Index ny);

}  // namespace batten
