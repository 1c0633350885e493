/// Reads, writes and draws meshes.
#include <unistd.h>

#include <filesystem>

#include "batten/io/io.h"
#include "batten/mesh/primitives.h"
#include "bench/bench.h"
#ifdef BATTEN_WITH_RENDER
#include "batten/render/render.h"
#endif

namespace batten::bench {

std::string file_section() {
  const std::string folder =
      (std::filesystem::temp_directory_path() / ("batten-files-" + std::to_string(getpid()))).string();
  std::filesystem::create_directory(folder);
  Mesh mesh;
  {
    const Subject two_million = subject(2000000);
    mesh = mesh_from_topology(two_million.topology);
    mesh.points = two_million.targets;
  }
  MarkdownTable table({"", "file, MB", "read, MB/s", "write, MB/s"});
  for (const std::string format : {"obj", "ply"}) {
    const std::string path = folder + "/mesh." + format;
    const std::vector<double> seconds = in_turn({[&] { write_mesh(path, mesh); }, [&] { read_mesh(path); }}, 5);
    const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(path));
    table.add({format, number(megabytes), number(megabytes / seconds[1]), number(megabytes / seconds[0])});
  }
  std::filesystem::remove_all(folder);
  return "## Files (warm page cache)\n\n" + table.text() + "\n";
}

#ifdef BATTEN_WITH_RENDER

std::string picture_section() {
  Scene scene;
  scene.surface = torus(1000, 500);  // 0.5 M quads, 1 M triangles
  const double seconds = in_turn({[&] { render(scene); }}, 3)[0];
  return "## Pictures\n\n1 M triangles at 1600x1200, 2x2 samples, soft shadows: " + number(seconds) + " s.\n\n";
}

#else

std::string picture_section() { return ""; }

#endif

}  // namespace batten::bench
