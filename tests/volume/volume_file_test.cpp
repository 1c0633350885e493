#include "batten/volume/volume_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include "batten/error.h"
#include "support/errors.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

class VolumeFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("batten-volumes-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
  }
  std::string bytes(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void expect_refused(const std::string& name, ErrorCode code, const std::string& part) const {
    test::expect_error([&] { read_volume(path(name)); }, code, part);
    test::expect_error([&] { read_volume(path(name)); }, code, name);
  }
  fs::path folder_;
};

Volume oblique() {
  VolumeGrid grid;
  grid.size = {5, 6, 7};
  grid.axes = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix() *
              Eigen::Vector3d(1.0, -0.5, 3.0).asDiagonal();
  grid.origin = {-10.0, 20.0, 30.0};
  return test::made_volume(grid, [](const Eigen::Vector3d& at) { return at[0] + 2.0 * at[1] - at[2]; });
}

/// A NIfTI header and its numbers, as the format's page says, without Batten or ITK.
std::string nifti(const std::array<std::int16_t, 5>& sizes, std::size_t numbers) {
  std::string file(352 + 4 * numbers, '\0');
  const auto put = [&](std::size_t at, auto value) { std::memcpy(&file[at], &value, sizeof value); };
  put(0, std::int32_t{348});
  for (std::size_t c = 0; c < sizes.size(); ++c) put(40 + 2 * c, sizes[c]);
  for (std::size_t c = sizes.size(); c < 8; ++c) put(40 + 2 * c, std::int16_t{1});
  put(70, std::int16_t{16});  // float
  put(72, std::int16_t{32});
  for (std::size_t c = 0; c < 4; ++c) put(76 + 4 * c, static_cast<float>(c + 1));
  put(108, 352.0F);
  put(112, 1.0F);
  put(123, '\2');             // millimetres
  put(254, std::int16_t{1});  // sform
  const std::array<float, 12> rows{2.0F, 0.0F, 0.0F, -90.0F, 0.0F, 3.0F, 0.0F, -125.0F, 0.0F, 0.0F, 4.0F, -71.0F};
  for (std::size_t r = 0; r < rows.size(); ++r) put(280 + 4 * r, rows[r]);
  std::memcpy(&file[344], "n+1", 4);
  for (std::size_t i = 0; i < numbers; ++i) put(352 + 4 * i, static_cast<float>(i));
  return file;
}

TEST_F(VolumeFile, KeepsNumbersAndPlacesInEveryFormat) {
  const Volume volume = oblique();
  for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.mha"}) {
    write_volume(path(name), volume);
    const Volume again = read_volume(path(name));
    EXPECT_EQ(again.grid.size, volume.grid.size) << name;
    EXPECT_EQ(again.values, volume.values) << name;
    EXPECT_LT((again.grid.axes - volume.grid.axes).cwiseAbs().maxCoeff(), 1e-5) << name;
    EXPECT_LT((again.grid.origin - volume.grid.origin).cwiseAbs().maxCoeff(), 1e-4) << name;
  }
}

TEST_F(VolumeFile, ANiftiFileLiesInRas) {
  write("a.nii", nifti({3, 2, 3, 4, 1}, 24));
  const Volume volume = read_volume(path("a.nii"));
  EXPECT_EQ(volume.at(1, 2, 3), 23.0F);
  EXPECT_LT((volume.grid.to_world({1.0, 2.0, 3.0}) - Eigen::Vector3d(-88.0, -119.0, -59.0)).norm(), 1e-6);
}

TEST_F(VolumeFile, AnNrrdFileInLpsIsTurned) {
  write("a.nrrd",
        "NRRD0004\ntype: float\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 2 2\n"
        "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (10,20,30)\nencoding: ascii\n\n0 1 2 3 4 5 6 7\n");
  const Volume volume = read_volume(path("a.nrrd"));
  EXPECT_LT((volume.grid.to_world({1.0, 0.0, 0.0}) - Eigen::Vector3d(-11.0, -20.0, 30.0)).norm(), 1e-9);
  EXPECT_EQ(volume.at(1, 0, 0), 1.0F);
}

TEST_F(VolumeFile, MasksAreBytes) {
  Volume mask = oblique();
  for (float& value : mask.values) value = value > 0.0F ? 1.0F : 0.0F;
  write_volume(path("a.nii"), mask, VoxelType::Byte);
  EXPECT_EQ(read_volume(path("a.nii")).values, mask.values);
  EXPECT_EQ(bytes("a.nii").size(), 352U + 5U * 6U * 7U);
}

TEST_F(VolumeFile, RefusesWhatIsNoVolume) {
  write("four.nii", nifti({4, 2, 3, 4, 5}, 120));
  expect_refused("four.nii", ErrorCode::BadFile, "4 dimensions");
  write("two.nii", nifti({2, 2, 3, 1, 1}, 6));
  expect_refused("two.nii", ErrorCode::BadFile, "2 dimensions");
  write("vector.nrrd",
        "NRRD0004\ntype: float\ndimension: 4\nsizes: 3 2 2 2\nkinds: vector domain domain domain\n"
        "encoding: ascii\n\n" +
            std::string(48, '1') + "\n");
  expect_refused("vector.nrrd", ErrorCode::BadFile, "3 numbers a voxel");
  for (const std::size_t at : {80, 256, 280, 324}) {
    std::string broken = nifti({3, 2, 3, 4, 1}, 24);
    const float number = at == 280 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
    std::memcpy(&broken[at], &number, sizeof number);
    write("nan.nii", broken);
    expect_refused("nan.nii", ErrorCode::BadFile, "number at byte " + std::to_string(at));
  }
  // An axis of other length than the voxels', and one that leans.
  for (const auto& [at, number] : {std::pair<std::size_t, float>{280, 1e6F}, {284, 0.5F}}) {
    std::string broken = nifti({3, 2, 3, 4, 1}, 24);
    std::memcpy(&broken[at], &number, sizeof number);
    write("axes.nii", broken);
    expect_refused("axes.nii", ErrorCode::BadFile, "cannot be read: the axes in its header (sform) are not at right");
  }
  write("text.nii", "no volume at all");
  expect_refused("text.nii", ErrorCode::BadFile, "");
  expect_refused("missing.nii", ErrorCode::FileNotReadable, "");
  write("a.obj", "v 0 0 0\n");
  expect_refused("a.obj", ErrorCode::UnknownFormat, ".nii.gz");
}

TEST_F(VolumeFile, RefusesClaimsThatTheFileCannotHold) {
  write("large.nii", nifti({3, 32000, 32000, 32000, 1}, 10));
  expect_refused("large.nii", ErrorCode::TooLarge, "2^31");
  write("claims.nii", nifti({3, 1200, 1200, 1200, 1}, 10));
  expect_refused("claims.nii", ErrorCode::BadFile, "more voxels than the file holds");
  write("huge.nrrd",
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 1000000 1000000 1000000\nendian: little\nencoding: raw\n\n1234");
  expect_refused("huge.nrrd", ErrorCode::TooLarge, "2^31");
}

TEST_F(VolumeFile, RefusesTruncatedFiles) {
  for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.mha"}) {
    write_volume(path(name), oblique());
    const std::string whole = bytes(name);
    write(name, whole.substr(0, whole.size() - (std::string(name) == "a.mha" ? 600 : 40)));
    expect_refused(name, ErrorCode::BadFile, "");
  }
}

TEST_F(VolumeFile, NamesTheVoxelThatIsNoNumber) {
  write("a.nrrd", "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n0 1 2 3 4 nan 6 7\n");
  expect_refused("a.nrrd", ErrorCode::NotFinite, "voxel (1, 0, 1)");
}

TEST_F(VolumeFile, WritesWholeFilesOrNone) {
  test::expect_error([&] { write_volume(path("a.hdr"), oblique()); }, ErrorCode::UnknownFormat, "pairs");
  test::expect_error([&] { write_volume("/proc/nowhere/a.nii", oblique()); }, ErrorCode::FileNotWritable, "a.nii");
  write_volume(path("b.nii.gz"), oblique());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace batten
