#include <cmath>

#include "batten/mesh/primitives.h"
#include "shapes.h"

namespace batten::models {

std::vector<Model> all_models() {
  std::vector<Model> models = {{"pipe-joint", pipe_joint()},
                               {"tripod", tripod()},
                               {"torus-knot", torus_knot()},
                               {"bracket", bracket()},
                               {"creature", creature()},
                               {"tetrahedron", tetrahedron()},
                               {"cube", cube()},
                               {"octahedron", octahedron()},
                               {"dodecahedron", dodecahedron()},
                               {"icosahedron", icosahedron()}};
  // Far more than a picture shows, and the same text wherever sines and cosines differ in their last bits.
  constexpr double kGrain = 1e4;
  for (Model& model : models) {
    const double grain = model.mesh.vertex_count() <= 20 ? 1e6 : kGrain;
    // Adding zero turns -0 into 0.
    model.mesh.points = (model.mesh.points * grain).array().round() / grain + 0.0;
  }
  return models;
}

std::vector<Model> broken_models() {
  for (const Model& model : all_models()) {
    if (model.name == "tripod") return {{"broken-tripod", broken_tripod(model.mesh)}};
  }
  return {};
}

}  // namespace batten::models
