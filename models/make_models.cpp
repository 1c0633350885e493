/// Writes the sample models: make_models FOLDER
#include <exception>
#include <iostream>
#include <utility>

#include "batten/io/io.h"
#include "batten/medial/medial_io.h"
#include "shapes.h"

int main(int count, char** words) {
  if (count != 2) {
    std::cerr << "usage: batten_models FOLDER\n";
    return 2;
  }
  try {
    std::vector<batten::models::Model> models = batten::models::all_models();
    for (batten::models::Model& model : batten::models::morph_models()) models.push_back(std::move(model));
    for (batten::models::Model& model : batten::models::broken_models()) models.push_back(std::move(model));
    for (batten::models::Model& model : batten::models::elastic_models()) models.push_back(std::move(model));
    for (const batten::models::Model& model : models)
      batten::write_mesh(std::string(words[1]) + "/" + model.name + ".obj", model.mesh);
    for (const batten::models::MedialSample& sample : batten::models::medial_models())
      batten::write_medial(std::string(words[1]) + "/" + sample.file, sample.model);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
