/// Writes the sample models: make_models FOLDER
#include <exception>
#include <iostream>

#include "batten/io/io.h"
#include "shapes.h"

int main(int count, char** words) {
  if (count != 2) {
    std::cerr << "usage: batten_models FOLDER\n";
    return 2;
  }
  try {
    for (const batten::models::Model& model : batten::models::all_models())
      batten::write_mesh(std::string(words[1]) + "/" + model.name + ".obj", model.mesh);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
