/// read_mesh on paths that are no mesh files, and on real files.
#include <unistd.h>

#include <algorithm>

#include "batten/parallel/parallel.h"
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

namespace fs = std::filesystem;

/// While it lives, a test that runs as root acts as an ordinary user.
class OrdinaryUser {
 public:
  OrdinaryUser() : was_root_(::geteuid() == 0) {
    if (was_root_) {
      EXPECT_EQ(::seteuid(65534), 0);
    }
  }
  ~OrdinaryUser() {
    if (was_root_) {
      EXPECT_EQ(::seteuid(0), 0);
    }
  }

 private:
  bool was_root_;
};

TEST(Read, AFileThatIsNotThereIsAnError) {
  expect_error([] { read_mesh("/nowhere/m.obj"); }, ErrorCode::FileNotReadable,
               "/nowhere/m.obj: cannot be read: No such");
}

TEST(Read, AFolderIsNoFile) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path("m.obj"));
  expect_error([&] { read_mesh(folder.path("m.obj")); }, ErrorCode::FileNotReadable, "it is a folder");
}

TEST(Read, AnEmptyFileIsAnErrorInEveryFormat) {
  const TemporaryFolder folder;
  for (const char* name : {"m.obj", "m.ply", "m.off", "m.stl", "m.xyz"}) {
    make_file(folder.path(name), "");
    expect_error([&] { read_mesh(folder.path(name)); }, ErrorCode::BadFile, "the file is empty");
    for (const std::string& text :
         {std::string("\n"), std::string("\xEF\xBB\xBF"), std::string(3, '\0'), std::string("#")}) {
      make_file(folder.path(name), text);
      EXPECT_EQ(error_of([&] { read_mesh(folder.path(name)); })->code(), ErrorCode::BadFile) << name;
    }
  }
}

TEST(Read, AFileWithoutPermissionIsAnError) {
  const TemporaryFolder folder;
  make_file(folder.path("m.obj"), "v 0 0 0\n");
  fs::permissions(folder.path("m.obj"), fs::perms::none);
  const OrdinaryUser user;  // root may read everything
  expect_error([&] { read_mesh(folder.path("m.obj")); }, ErrorCode::FileNotReadable, "Permission denied");
}

TEST(Read, AFileThatBecomesShorterMeanwhileIsAnError) {
  const TemporaryFolder folder;
  make_file(folder.path("m.obj"), std::string(100000, '\n') + "v 0 0 0\n");
  const auto shorten = [&](double /*done*/) { return ::truncate(folder.path("m.obj").c_str(), 10) == 0; };
  expect_error([&] { read_mesh(folder.path("m.obj"), "", shorten); }, ErrorCode::FileNotReadable,
               "another program made it shorter meanwhile");
}

TEST(Read, TheFormatIsTheOneAskedForElseTheExtension) {
  const TemporaryFolder folder;
  make_file(folder.path("m.OBJ"), "\xEF\xBB\xBFv 0 0 0\n");
  make_file(folder.path("m.txt"), "1 2 3\n");
  EXPECT_EQ(read_mesh(folder.path("m.OBJ")).vertex_count(), 1);
  EXPECT_EQ(read_mesh(folder.path("m.txt"), ".XYZ").vertex_count(), 1);
  expect_error([&] { read_mesh(folder.path("m.txt")); }, ErrorCode::UnknownFormat, "'txt' is unknown; give one of obj");
  expect_error([] { read_mesh("-"); }, ErrorCode::UnknownFormat, "give one of obj");
}

TEST(Read, TheNumberOfThreadsChangesNothing) {
  const TemporaryFolder folder;
  for (const char* name : {"m.obj", "m.ply", "m.off"}) {
    write_mesh(folder.path(name), random_mesh(40000, 40000));
    const Mesh free = read_mesh(folder.path(name));
    const ThreadLimit limit(1);
    expect_same_mesh(free, read_mesh(folder.path(name)));
  }
}

/// All files in the data of that extension; empty where there is none.
std::vector<std::string> data_files(const std::string& extension) {
  std::vector<std::string> files;
  const char* data = std::getenv("BATTEN_DATA");
  if (data == nullptr) return files;
  for (const auto& entry : fs::recursive_directory_iterator(data)) {
    if (entry.path().extension() == extension) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

constexpr const char* kNoData = "set BATTEN_DATA to the folder with the test data";

TEST(RealFiles, EveryObjComesBackTheSame) {
  const std::vector<std::string> files = data_files(".obj");
  if (files.empty()) GTEST_SKIP() << kNoData;
  EXPECT_GT(files.size(), 70U);
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const Mesh mesh = read_mesh(file);
    EXPECT_GT(mesh.face_count(), 0);
    expect_same_mesh(mesh, round_trip(mesh, "obj"));
  }
}

TEST(RealFiles, EveryObjIsTheSameInTinyChunks) {
  const std::vector<std::string> files = data_files(".obj");
  if (files.empty()) GTEST_SKIP() << kNoData;
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    expect_same_mesh(read_mesh(file), parse(io::read_obj, file_text(file), 777));
  }
}

TEST(RealFiles, EveryObjKeepsItsShapeInPlyOffAndStl) {
  const std::vector<std::string> files = data_files(".obj");
  if (files.empty()) GTEST_SKIP() << kNoData;
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const Mesh mesh = read_mesh(file);
    for (const bool binary : {true, false}) {
      const Mesh ply = round_trip(mesh, "ply", binary);
      EXPECT_TRUE(same_bits(mesh.points, ply.points));
      expect_same_faces(mesh, ply);
    }
    const Mesh off = round_trip(mesh, "off");
    EXPECT_TRUE(same_bits(mesh.points, off.points));
    expect_same_faces(mesh, off);
    const auto triangles = static_cast<Index>(mesh.face_vertices.size()) - 2 * mesh.face_count();
    EXPECT_EQ(round_trip(mesh, "stl").face_count(), triangles);
  }
}

TEST(RealFiles, EveryXyzComesBackTheSame) {
  const std::vector<std::string> files = data_files(".xyz");
  if (files.empty()) GTEST_SKIP() << kNoData;
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const Mesh mesh = read_mesh(file);
    EXPECT_GE(mesh.vertex_count(), 1000);
    expect_same_mesh(mesh, round_trip(mesh, "xyz"));
  }
}

/// Counts from the files themselves (grep -c), tags from their text.
TEST(RealFiles, CountsAndTagsAreThoseOfTheFiles) {
  const char* data = std::getenv("BATTEN_DATA");
  if (data == nullptr) GTEST_SKIP() << kNoData;
  const std::string folder(data);
  const Mesh armor = read_mesh(folder + "/meshes/armorguy.obj");
  EXPECT_EQ(armor.vertex_count(), 10022);
  EXPECT_EQ(armor.face_count(), 8639);
  EXPECT_EQ(armor.creases.size(), 7101U);
  const Mesh bunny = read_mesh(folder + "/meshes/stanford-bunny.obj");
  EXPECT_EQ(bunny.vertex_count(), 35947);
  EXPECT_EQ(bunny.face_count(), 69451);
  EXPECT_EQ(read_mesh(folder + "/osd-shapes/catmark_hole_test1.obj").holes, std::vector<Index>{1});
  EXPECT_EQ(read_mesh(folder + "/osd-shapes/loop_chaikin1.obj").crease_method, CreaseMethod::Chaikin);
  EXPECT_EQ(read_mesh(folder + "/osd-shapes/catmark_smoothtris0.obj").triangle_rule, TriangleRule::Catmark);
  EXPECT_EQ(read_mesh(folder + "/osd-shapes/catmark_edgenone.obj").boundary, BoundaryRule::None);
  EXPECT_EQ(read_mesh(folder + "/osd-shapes/loop_triangle_edgeonly.obj").boundary, BoundaryRule::EdgeOnly);
}

}  // namespace
}  // namespace batten::io_tests
