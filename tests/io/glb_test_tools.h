/// Written GLB files as tinygltf reads them.
#pragma once
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <string>

namespace batten::io_tests {

inline tinygltf::Model load_glb(const std::string& path) {
  tinygltf::Model model;
  std::string error;
  std::string warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, path)) << error;
  EXPECT_EQ(error + warning, "");
  return model;
}

}  // namespace batten::io_tests
