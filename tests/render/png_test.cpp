#include <gtest/gtest.h>
#include <png.h>

#include <cstring>
#include <filesystem>

#include "batten/error.h"
#include "batten/render/render.h"
#include "render/pixels.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

Picture noise(int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  picture.pixels.resize(static_cast<std::size_t>(3 * width * height));
  std::uint32_t state = 1;
  for (unsigned char& byte : picture.pixels) {
    state = state * 1664525U + 1013904223U;
    byte = static_cast<unsigned char>(state >> 24);
  }
  return picture;
}

Picture decode(const Buffer<unsigned char>& bytes) {
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(image.format, PNG_FORMAT_RGB);
  Picture picture;
  picture.width = static_cast<int>(image.width);
  picture.height = static_cast<int>(image.height);
  picture.pixels.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr), 0);
  return picture;
}

TEST(Png, DecodesToThePicture) {
  for (const int width : {1, 7, 640}) {
    const Picture picture = noise(width, 5);
    const Picture back = decode(encode_png(picture));
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, 5);
    EXPECT_EQ(back.pixels, picture.pixels);
  }
}

TEST(Png, IsWrittenWholeOrNotAtAll) {
  const fs::path folder = fs::temp_directory_path() /
                          ("batten_png_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_test");
  fs::create_directories(folder);
  const fs::path path = folder / "picture.png";
  const Picture picture = noise(9, 4);
  write_png(path.string(), picture);
  EXPECT_EQ(fs::file_size(path), encode_png(picture).size());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  EXPECT_EQ(test::code_of([&] { write_png((path / "such.png").string(), picture); }), ErrorCode::FileNotWritable);
  // A folder stands where the file should go: the temporary is removed again.
  fs::create_directories(folder / "taken.png" / "full");
  EXPECT_EQ(test::code_of([&] { write_png((folder / "taken.png").string(), picture); }), ErrorCode::FileNotWritable);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 2);
  fs::remove_all(folder);
}

TEST(Png, RefusesPixelsThatDoNotFit) {
  Picture picture = noise(4, 4);
  picture.pixels.pop_back();
  EXPECT_EQ(test::code_of([&] { encode_png(picture); }), ErrorCode::BadShape);
  EXPECT_EQ(test::code_of([] { encode_png(Picture()); }), ErrorCode::BadShape);
}

}  // namespace
}  // namespace batten
