/// Failed writing leaves no incomplete file, and invalid meshes are not written.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <limits>
#include <thread>

#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

namespace fs = std::filesystem;

/// While it exists, files cannot grow beyond `bytes`, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(Write, AFailureLeavesTheOldFileAndNoOther) {
  const TemporaryFolder folder;
  for (const char* name : {"m.obj", "m.ply", "m.off", "m.xyz"}) {
    make_file(folder.path(name), "old");
    {
      const FileSizeLimit limit(100000);
      expect_error([&] { write_mesh(folder.path(name), random_mesh(20000, 20000)); }, ErrorCode::FileNotWritable,
                   folder.path(name) + ": cannot be written: File too large");
    }
    EXPECT_EQ(file_text(folder.path(name)), "old");
  }
  EXPECT_EQ(folder.file_count(), 4);
}

TEST(Write, AFullDeviceIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  expect_error([] { write_mesh("/dev/full", random_mesh(9, 9), {"obj"}); }, ErrorCode::FileNotWritable,
               "No space left");
}

TEST(Write, DevicesAreWrittenToAndStay) {
  write_mesh("/dev/null", random_mesh(9, 9), {"ply"});
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(Write, PipesAreWrittenToAndReadFrom) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo(folder.path("pipe").c_str(), 0600), 0);
  const Mesh mesh = random_mesh(30000, 20000);
  std::thread writer([&] { write_mesh(folder.path("pipe"), mesh, {"obj"}); });
  const Mesh back = read_mesh(folder.path("pipe"), "obj");
  writer.join();
  expect_same_mesh(mesh, back);
  EXPECT_TRUE(fs::is_fifo(folder.path("pipe")));
}

/// A descriptor that is another one for a while.
class Redirected {
 public:
  Redirected(int descriptor, const std::string& path, int flags) : descriptor_(descriptor), kept_(::dup(descriptor)) {
    const int file = ::open(path.c_str(), flags, 0600);
    ::dup2(file, descriptor);
    ::close(file);
  }
  ~Redirected() {
    ::dup2(kept_, descriptor_);
    ::close(kept_);
  }
  Redirected(const Redirected&) = delete;
  Redirected& operator=(const Redirected&) = delete;

 private:
  int descriptor_;
  int kept_;
};

TEST(Write, DashIsStandardOutputAndInput) {
  const TemporaryFolder folder;
  const Mesh mesh = random_mesh(100, 50);
  for (const char* name : {"-", "/dev/stdout"}) {
    {
      const Redirected output(STDOUT_FILENO, folder.path("out"), O_WRONLY | O_CREAT | O_TRUNC);
      write_mesh(name, mesh, {"ply"});
    }
    const Redirected input(STDIN_FILENO, folder.path("out"), O_RDONLY);
    expect_same_mesh(mesh, read_mesh("-", "ply"));
  }
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(Write, AMissingFolderIsMade) {
  const TemporaryFolder folder;
  write_mesh(folder.path("a/b/m.obj"), random_mesh(9, 9));
  EXPECT_EQ(read_mesh(folder.path("a/b/m.obj")).face_count(), 9);
}

TEST(Write, AFolderThatCannotBeMadeIsAnError) {
  const TemporaryFolder folder;
  make_file(folder.path("file"), "x");
  expect_error([&] { write_mesh(folder.path("file/m.obj"), random_mesh(9, 9)); }, ErrorCode::FileNotWritable,
               "cannot be made");
}

TEST(Write, AFolderIsNoTarget) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path("m.obj"));
  for (const char* name : {"m.obj", "m.obj/"}) {
    expect_error([&] { write_mesh(folder.path(name), random_mesh(9, 9), {"obj"}); }, ErrorCode::FileNotWritable,
                 "it is a folder");
  }
}

TEST(Write, ALinkStaysALinkAndPermissionsStay) {
  const TemporaryFolder folder;
  make_file(folder.path("real.obj"), "old");
  fs::permissions(folder.path("real.obj"), fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real.obj", folder.path("link.obj"));
  write_mesh(folder.path("link.obj"), random_mesh(9, 9));
  EXPECT_TRUE(fs::is_symlink(folder.path("link.obj")));
  EXPECT_EQ(read_mesh(folder.path("real.obj")).face_count(), 9);
  EXPECT_EQ(fs::status(folder.path("real.obj")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(Write, AnAtomicWriteThatThrowsLeavesNothing) {
  const TemporaryFolder folder;
  const auto fails = [](const std::string& path) {
    make_file(path, "half");
    throw Error(ErrorCode::Cancelled, "stop");
  };
  expect_error([&] { write_atomically(folder.path("report.json"), fails); }, ErrorCode::Cancelled, "stop");
  EXPECT_EQ(folder.file_count(), 0);
  write_atomically(folder.path("report.json"), [](const std::string& path) { make_file(path, "{}"); });
  EXPECT_EQ(file_text(folder.path("report.json")), "{}");
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(Write, AnUnknownTypeListsTheKnownOnes) {
  const Mesh mesh = random_mesh(3, 1);
  expect_error([&] { write_mesh("m.fbx", mesh); }, ErrorCode::UnknownFormat,
               "'fbx' is unknown; give one of obj, ply, off");
  expect_error([&] { write_mesh("-", mesh); }, ErrorCode::UnknownFormat, "give one of obj");
  expect_error([&] { write_mesh("noextension", mesh); }, ErrorCode::UnknownFormat, "no file type");
}

TEST(Write, WrongMeshesAreRefusedAndNothingIsWritten) {
  const TemporaryFolder folder;
  const auto expect = [&](void (*spoil)(Mesh&), ErrorCode code) {
    Mesh mesh = random_mesh(9, 3);
    spoil(mesh);
    for (const char* name : {"m.obj", "m.ply", "m.off"}) {
      expect_error([&] { write_mesh(folder.path(name), mesh); }, code, name);
    }
  };
  expect([](Mesh& m) { m.points(8, 2) = std::nan(""); }, ErrorCode::NotFinite);
  expect([](Mesh& m) { m.face_vertices[1] = 9; }, ErrorCode::IndexOutOfRange);
  expect([](Mesh& m) { m.face_vertices[1] = -1; }, ErrorCode::IndexOutOfRange);
  expect([](Mesh& m) { m.face_offsets[1] = 2; }, ErrorCode::DegenerateFace);
  expect([](Mesh& m) { m.face_offsets.back() += 1; }, ErrorCode::BadShape);
  expect([](Mesh& m) { m.face_offsets[1] = 1000; }, ErrorCode::DegenerateFace);
  expect([](Mesh& m) { m.face_offsets.clear(); }, ErrorCode::BadShape);
  expect([](Mesh& m) { m.creases = {{0, 9, 1}}; }, ErrorCode::IndexOutOfRange);
  expect([](Mesh& m) { m.corners = {{0, std::nan("")}}; }, ErrorCode::NotFinite);
  expect([](Mesh& m) { m.holes = {3}; }, ErrorCode::IndexOutOfRange);
  expect([](Mesh& m) { m.attributes = {{"a", Values(8, 1), {}}}; }, ErrorCode::BadShape);
  expect([](Mesh& m) { m.attributes = {{"uv", Values(9, 3), {}}}; }, ErrorCode::BadShape);
  expect(
      [](Mesh& m) {
        m.attributes = {{"a", Values(2, 1), Buffer<Index>(m.face_vertices.size(), 2)}};
      },
      ErrorCode::IndexOutOfRange);
  expect([](Mesh& m) { m.groups = {{"g", "a\nv 1 2 3", 0}}; }, ErrorCode::BadArgument);
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
}  // namespace batten::io_tests
