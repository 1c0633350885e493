/// A folder of DICOM slices, written here byte by byte as the standard's part 10 says.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "batten/error.h"
#include "batten/volume/volume_file.h"
#include "support/errors.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

void put_word(std::string& bytes, unsigned value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 255);
}

/// An element with explicit VR, little-endian; texts are padded to an even length.
void put(std::string& bytes, unsigned group, unsigned element, const std::string& kind, std::string value) {
  if (value.size() % 2 != 0) value += kind == "UI" ? '\0' : ' ';
  put_word(bytes, group, 2);
  put_word(bytes, element, 2);
  bytes += kind;
  if (kind == "OW") put_word(bytes, 0, 2);
  put_word(bytes, static_cast<unsigned>(value.size()), kind == "OW" ? 4 : 2);
  bytes += value;
}

void put_number(std::string& bytes, unsigned group, unsigned element, unsigned value) {
  std::string text;
  put_word(text, value, 2);
  put(bytes, group, element, "US", text);
}

/// 4 columns of 2 mm, 3 rows of 3 mm, slices 5 mm apart from z = 7 up; the number says column, row and slice.
std::string slice(int number, const std::string& series) {
  const std::string kind = "1.2.840.10008.5.1.4.1.1.4";  // an MR image
  const std::string name = "1.2.3.4.5." + series + "." + std::to_string(number + 1);
  std::string meta;
  put(meta, 2, 2, "UI", kind);
  put(meta, 2, 3, "UI", name);
  put(meta, 2, 0x10, "UI", "1.2.840.10008.1.2.1");
  std::string length;
  put_word(length, static_cast<unsigned>(meta.size()), 4);
  std::string bytes = std::string(128, '\0') + "DICM";
  put(bytes, 2, 0, "UL", length);
  bytes += meta;
  put(bytes, 8, 0x16, "UI", kind);
  put(bytes, 8, 0x18, "UI", name);
  put(bytes, 8, 0x60, "CS", "MR");
  put(bytes, 0x20, 0xd, "UI", "1.2.3.4");
  put(bytes, 0x20, 0xe, "UI", "1.2.3.4.5." + series);
  put(bytes, 0x20, 0x13, "IS", std::to_string(number + 1));
  put(bytes, 0x20, 0x32, "DS", "-10\\-20\\" + std::to_string(7 + 5 * number));
  put(bytes, 0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0");
  put(bytes, 0x20, 0x52, "UI", "1.2.3.9");
  put_number(bytes, 0x28, 2, 1);
  put(bytes, 0x28, 4, "CS", "MONOCHROME2");
  put_number(bytes, 0x28, 0x10, 3);
  put_number(bytes, 0x28, 0x11, 4);
  put(bytes, 0x28, 0x30, "DS", "3\\2");
  put_number(bytes, 0x28, 0x100, 16);
  put_number(bytes, 0x28, 0x101, 16);
  put_number(bytes, 0x28, 0x102, 15);
  put_number(bytes, 0x28, 0x103, 0);
  std::string pixels;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 4; ++column) put_word(pixels, 100 * number + 10 * row + column, 2);
  }
  put(bytes, 0x7fe0, 0x10, "OW", pixels);
  return bytes;
}

class DicomFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("batten-dicom-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  fs::path folder_;
};

TEST_F(DicomFolder, SlicesAreOrderedByTheirPlaces) {
  // In the order of their names the slices would be 2, 0, 1.
  write("a.dcm", slice(2, "6"));
  write("b.dcm", slice(0, "6"));
  write("c.dcm", slice(1, "6"));
  const Volume volume = read_volume(folder_.string());
  EXPECT_EQ(volume.grid.size, (std::array<Index, 3>{4, 3, 3}));
  for (Index k = 0; k < 3; ++k) {
    for (Index j = 0; j < 3; ++j) {
      for (Index i = 0; i < 4; ++i) EXPECT_EQ(volume.at(i, j, k), 100 * k + 10 * j + i);
    }
  }
  // DICOM counts in LPS: (-10, -20, 7) there.
  EXPECT_LT((volume.grid.origin - Eigen::Vector3d(10, 20, 7)).norm(), 1e-9);
  EXPECT_LT((volume.grid.axes - Eigen::Matrix3d(Eigen::Vector3d(-2, -3, 5).asDiagonal())).norm(), 1e-9);
}

TEST_F(DicomFolder, TwoSeriesAreRefused) {
  write("a.dcm", slice(0, "6"));
  write("b.dcm", slice(1, "7"));
  test::expect_error([&] { read_volume(folder_.string()); }, ErrorCode::BadFile, "2 DICOM series");
}

TEST_F(DicomFolder, AFolderWithoutSlicesIsRefused) {
  write("note.txt", "no image\n");
  test::expect_error([&] { read_volume(folder_.string()); }, ErrorCode::BadFile, "no DICOM slices");
}

}  // namespace
}  // namespace batten
