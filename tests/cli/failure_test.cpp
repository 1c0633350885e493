/// Nothing is ever lost: whatever goes wrong, the tool says what in one line, ends with 1, leaves the old output as it
/// was to the byte, and no file of its own beside it.
#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <thread>

#include "batten/io/io.h"
#include "batten/mesh/primitives.h"
#include "cli/process.h"

// g++ has a macro for it, clang a question.
#if defined(__SANITIZE_ADDRESS__)
#define BATTEN_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#define BATTEN_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#else
#define BATTEN_ADDRESS_SANITIZER 0
#endif

namespace batten::cli_tests {
namespace {

using Prepare = std::function<void()>;
using Words = std::vector<std::string>;

class Failure : public testing::Test {
 protected:
  Failure() {
    std::string pattern = (fs::temp_directory_path() / "batten-failure-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~Failure() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      files[entry.path().string()] = entry.is_regular_file() && ::access(entry.path().c_str(), R_OK) == 0
                                         ? text_of(entry.path())
                                         : "not a file to read";
    }
    return files;
  }

  /// Runs the tool, which must fail with a line that has `part`, and change nothing in the folder.
  void expect_failure(
      const Words& arguments, const std::string& part, const Prepare& prepare = [] {}) const {
    const auto before = contents();
    Process tool(folder_, arguments, prepare);
    EXPECT_EQ(tool.wait(), 1) << part;
    const std::string errors = tool.errors();
    EXPECT_NE(errors.find(part), std::string::npos) << errors;
    EXPECT_EQ(errors.rfind("batten: ", 0), 0U) << errors;
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    EXPECT_TRUE(contents() == before) << part;
  }

  fs::path folder_;
};

const std::string kPrecious = "# precious\nv 0 0 0\n";

TEST_F(Failure, ATruncatedFileIsNamed) {
  const Mesh mesh = torus(12, 9);
  for (const std::string format : {"ply", "stl"}) {
    const std::string name = "cut." + format;
    write_mesh(path("whole." + format), mesh);
    const std::string whole = text_of(path("whole." + format));
    write("out.obj", kPrecious);
    for (const std::size_t size : {std::size_t{1}, std::size_t{50}, whole.size() / 2, whole.size() - 1}) {
      write(name, whole.substr(0, size));
      expect_failure({"convert", name, "-o", "out.obj"}, name);
    }
  }
  write_mesh(path("whole.obj"), mesh);
  const std::string whole = text_of(path("whole.obj"));
  write("cut.obj", whole.substr(0, whole.find(' ', whole.rfind('f') + 2)));
  expect_failure({"interpolate", "cut.obj", "-o", "out.obj"}, "cut.obj:216: a face needs 3 corners or more");
  write("cut.obj", whole.substr(0, whole.find(' ', 2)));
  expect_failure({"interpolate", "cut.obj", "-o", "out.obj"}, "cut.obj:1: missing y coordinate");
}

TEST_F(Failure, AFolderIsNoOutput) {
  write_mesh(path("in.obj"), cube());
  fs::create_directory(path("out.obj"));
  expect_failure({"convert", "in.obj", "-o", "out.obj"}, "out.obj: cannot be written: it is a folder");
  expect_failure({"subdivide", "in.obj", "-o", "out.obj/", "--output-format", "obj"},
                 "out.obj/: cannot be written: it is a folder");
}

/// A file system of its own over the folder, with room for `bytes`. Root may mount one, unless a container forbids it.
class SmallDisk {
 public:
  SmallDisk(const fs::path& folder, std::size_t bytes) : folder_(folder.string()) {
    const std::string options = "size=" + std::to_string(bytes);
    mounted_ = ::unshare(CLONE_NEWNS) == 0 && ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
               ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, options.c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount(folder_.c_str());
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool mounted() const { return mounted_; }

 private:
  std::string folder_;
  bool mounted_ = false;
};

TEST_F(Failure, AFullDiskLeavesTheOldFile) {
  const SmallDisk disk(folder_, std::size_t{1} << 18);
  write_mesh(path("in.ply"), torus(40, 30));
  write("out.obj", kPrecious);
  if (disk.mounted()) {
    expect_failure({"subdivide", "in.ply", "--levels", "3", "-o", "out.obj"}, "out.obj: cannot be written: No space");
  } else {
    expect_failure({"convert", "in.ply", "-o", "/dev/full", "--output-format", "obj"},
                   "/dev/full: cannot be written: No space left on device");
  }
}

TEST_F(Failure, ALimitOnFilesLeavesTheOldFile) {
  write_mesh(path("in.ply"), torus(40, 30));
  const auto limit = [] {
    const rlimit bytes{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &bytes);
  };
  for (const char* out : {"out.obj", "out.ply", "out.off", "out.stl"}) {
    write(out, kPrecious);
    expect_failure({"convert", "in.ply", "-o", out}, std::string(out) + ": cannot be written: File too large", limit);
  }
}

/// A volume of 12 voxels a side with a ball in it, as MetaImage.
std::string ball_volume() {
  constexpr int kSize = 12;
  std::string file = "NDims = 3\nDimSize = 12 12 12\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
  for (int i = 0; i < kSize * kSize * kSize; ++i) {
    const double x = i % kSize - 5.5;
    const double y = i / kSize % kSize - 5.5;
    const double z = i / (kSize * kSize) - 5.5;
    file += x * x + y * y + z * z < 16.0 ? '\1' : '\0';
  }
  return file;
}

/// Of each verb the options that write a file; the file's name is the last word.
TEST_F(Failure, AFullDiskLeavesTheOldFileOfEveryVerb) {
  const std::string models = BATTEN_SOURCE_DIR "/models/";
  const std::string bean = models + "bean.srep.json";
  write_mesh(path("in.obj"), torus(10, 8));
  write("volume.mha", ball_volume());
  write("scene.json", "{\"mesh\": \"" + models +
                          "creature.obj\", \"material\": {\"density\": 1}, \"time\": {\"seconds\": "
                          "0.02, \"step\": 0.01}}");
  const std::vector<Words> commands{
      {"convert", "in.obj", "-o", "out.ply"},
      {"repair", "in.obj", "-o", "out.obj"},
      {"info", "in.obj", "--report", "out.json"},
      {"info", "in.obj", "--curvature", "-o", "out.ply"},
      {"interpolate", "in.obj", "-o", "out.obj"},
      {"interpolate", "in.obj", "--fair", "-o", "out.glb"},
      {"interpolate", "in.obj", "--compare-methods", "--plot", "out.svg"},
      {"subdivide", "in.obj", "--chord", "1%", "-o", "out.stl"},
      {"render", "in.obj", "-o", "out.png"},
      {"distance", "in.obj", "in.obj", "-o", "out.ply"},
      {"distance", "in.obj", "in.obj", "--report", "out.json"},
      {"texture", "in.obj", "-o", "out.ply"},
      {"denoise", "in.obj", "-o", "out.obj"},
      {"sharpen", "in.obj", "-o", "out.obj"},
      {"bands", "in.obj", "-o", "out.obj"},
      {"bands", "in.obj", "--plot", "out.png"},
      {"morph", "in.obj", "in.obj", "--at", "0.5", "-o", "out.obj"},
      {"morph", "in.obj", "in.obj", "-o", "out.glb"},
      {"simulate", "scene.json", "-o", "out.glb"},
      {"simulate", "scene.json", "--state", "out.state"},
      {"simulate", "scene.json", "--plot", "out.svg"},
      {"fit", "in.obj", "--init", "sphere", "--vertices", "98", "--rounds", "1", "-o", "out.obj"},
      {"fit", "in.obj", "--init", "sphere", "--vertices", "98", "--rounds", "1", "--residuals", "out.ply"},
      {"fit", "in.obj", "--init", "sphere", "--vertices", "98", "--rounds", "1", "--film", "out.glb"},
      {"segment", "volume.mha", "--vertices", "26", "-o", "out.obj"},
      {"segment", "volume.mha", "--vertices", "26", "--overlay", "out.png"},
      {"medial", bean, "-o", "out.obj"},
      {"medial", bean, "--sheet", "out.obj"},
      {"medial", bean, "--model", "out.json"},
  };
  const auto limit = [] {
    const rlimit bytes{512, 512};  // and a message has room
    ::setrlimit(RLIMIT_FSIZE, &bytes);
  };
  for (Words words : commands) {
    const std::string out = words.back();
    SCOPED_TRACE(words.front() + " " + words[words.size() - 2] + " " + out);
    write(out, kPrecious);
    words.push_back("--quiet");
    expect_failure(words, out + ": cannot be written: File too large", limit);
    fs::remove(path(out));
  }
}

TEST_F(Failure, AClosedPipeIsAnError) {
  write_mesh(path("in.ply"), torus(40, 30));
  const auto close_reader = [] {
    int ends[2];
    if (::pipe(ends) == 0 && ::dup2(ends[1], STDOUT_FILENO) >= 0) ::close(ends[0]);
  };
  expect_failure({"convert", "in.ply", "-o", "-", "--output-format", "obj"},
                 "standard output: cannot be written: Broken pipe", close_reader);
  expect_failure({"info", "in.ply"}, "standard output: cannot be written: Broken pipe", close_reader);
}

/// Sends the signal as soon as the temporary file stands there; nothing when the tool was faster.
std::optional<int> stop_while_writing(const fs::path& folder, const Words& arguments, int signal, std::string& errors) {
  Process tool(folder, arguments);
  const auto writing = [&] {
    return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(),
                       [](const auto& entry) { return entry.path().extension() == ".tmp"; });
  };
  while (!writing()) {
    if (!tool.is_running()) return std::nullopt;
  }
  tool.send(signal);
  const int status = tool.wait();
  errors = tool.errors();
  if (status == 0) return std::nullopt;
  return status;
}

TEST_F(Failure, AStopWhileWritingLeavesTheOldFile) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::optional<int> status;
    std::string errors;
    std::map<std::string, std::string> before;
    // A mesh that takes tenths of a second to write; a larger one where the machine was faster than this test.
    for (Index size = 500; !status && size <= 4000; size *= 2) {
      write_mesh(path("in.ply"), grid(size, size));
      write("out.obj", kPrecious);
      before = contents();
      status = stop_while_writing(folder_, {"convert", "in.ply", "-o", "out.obj"}, signal, errors);
    }
    ASSERT_TRUE(status) << "the tool was never met while it wrote";
    EXPECT_EQ(*status, 1);
    EXPECT_EQ(errors, "batten: interrupted; unfinished files are as they were\n");
    EXPECT_TRUE(contents() == before);
  }
}

/// Each is at work for some tenths of a second when the signal comes; one that has already ended has ended well.
TEST_F(Failure, AStopWhileWorkingLeavesTheOldFileOfEveryVerb) {
  write_mesh(path("in.ply"), torus(200, 120));
  const std::vector<Words> commands{
      {"interpolate", "in.ply", "--fair"},
      {"interpolate", "in.ply", "--normals", "estimate"},
      {"subdivide", "in.ply", "--levels", "4"},
      {"subdivide", "in.ply", "--chord", "0.0001%"},
      {"render", "in.ply"},
      {"distance", "in.ply", "in.ply"},
      {"denoise", "in.ply", "--passes", "4000"},
      {"sharpen", "in.ply"},
      {"bands", "in.ply", "--gains", "1,1,1,1,1,1,1"},
      {"morph", "in.ply", "in.ply", "--resample", "--at", "0.5"},
      {"simulate", BATTEN_SOURCE_DIR "/models/balloon.scene.json", "--equilibrium"},
      {"fit", "in.ply"},
      {"repair", "in.ply"},
      {"info", "in.ply", "--curvature"},
  };
  int met = 0;
  for (Words words : commands) {
    SCOPED_TRACE(words.front());
    const std::string out = words.front() == "render" ? "out.png" : "out.ply";
    write(out, kPrecious);
    const auto before = contents();
    words.insert(words.end(), {"-o", out});
    Process tool(folder_, words);
    while (tool.is_running() && !tool.handles(SIGINT)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    tool.send(SIGINT);
    if (tool.wait() == 0) continue;
    ++met;
    EXPECT_EQ(tool.wait(), 1);
    const std::string errors = tool.errors();
    const std::string last = "batten: interrupted; unfinished files are as they were\n";
    EXPECT_TRUE(errors.size() >= last.size() && errors.substr(errors.size() - last.size()) == last) << errors;
    EXPECT_TRUE(contents() == before);
  }
  EXPECT_GT(met, 0);
}

TEST_F(Failure, AStopWhileWaitingForInputEndsTheWait) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  Process tool(folder_, {"convert", "-", "--input-format", "obj", "-o", "out.obj"},
               [&] { ::dup2(ends[0], STDIN_FILENO); });
  while (tool.is_running() && !tool.handles(SIGINT)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  tool.send(SIGINT);
  EXPECT_EQ(tool.wait(), 1);
  EXPECT_EQ(tool.errors(), "batten: interrupted; unfinished files are as they were\n");
  EXPECT_TRUE(contents().empty());
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_F(Failure, AnInputWithoutPermissionIsNamed) {
  write_mesh(path("in.obj"), cube());
  write("out.obj", kPrecious);
  fs::permissions(path("in.obj"), fs::perms::none);
  const auto obey_permissions = [] {
    constexpr int kOverride = 1;  // CAP_DAC_OVERRIDE and CAP_DAC_READ_SEARCH: what lets root read everything
    constexpr int kReadSearch = 2;
    ::prctl(PR_CAPBSET_DROP, kOverride);
    ::prctl(PR_CAPBSET_DROP, kReadSearch);
  };
  expect_failure({"convert", "in.obj", "-o", "out.obj"}, "in.obj: cannot be read: Permission denied", obey_permissions);
}

TEST_F(Failure, AHeaderThatClaimsTooMuchIsRefused) {
  const std::string properties = "property float x\nproperty float y\nproperty float z\n";
  write("text.ply", "ply\nformat ascii 1.0\nelement vertex 2147483648\n" + properties + "end_header\n0 0 0\n");
  write("bytes.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 2147483648\n" + properties + "end_header\n0000");
  write("fewer.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 2147483646\n" + properties + "end_header\n0000");
  write("many.off", "OFF\n2147483648 1 0\n0 0 0\n");
  write("fewer.off", "OFF\n2147483646 1 0\n0 0 0\n");
  write("out.obj", kPrecious);
  // No more memory than this may be asked for: the claim alone must not cost anything.
  const auto limit = [] {
#if BATTEN_ADDRESS_SANITIZER
    // Its shadow takes terabytes of addresses, so it has a limit of its own.
    ::setenv("ASAN_OPTIONS", "max_allocation_size_mb=2048", 1);
#else
    const rlimit bytes{rlim_t{1} << 31, rlim_t{1} << 31};
    ::setrlimit(RLIMIT_AS, &bytes);
#endif
  };
  for (const char* name : {"text.ply", "bytes.ply", "fewer.ply", "many.off", "fewer.off"}) {
    for (const char* verb : {"info", "interpolate"}) {
      Words arguments{verb, name};
      if (verb == std::string("interpolate")) arguments.insert(arguments.end(), {"-o", "out.obj"});
      expect_failure(arguments, name, limit);
    }
  }
}

}  // namespace
}  // namespace batten::cli_tests
