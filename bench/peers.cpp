/// peers_bench [PAGE [jets|butterfly]]: runs the tessellator, jets, or Modified Butterfly against other libraries on
/// the same work, alternating, in one run. Writes its part of docs/performance.md.
#include "bench/peers.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "batten/io/io.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/tessellator.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

constexpr int kRounds = 7;

struct Case {
  std::string model;
  int refined;  ///< steps before, which make a fine control mesh
  int levels;
};

Mesh load(const Case& which) {
  const char* data = std::getenv("BATTEN_DATA");
  Mesh mesh = read_mesh(std::string(data) + "/meshes/" + which.model + ".obj");
  mesh.attributes.clear();
  if (which.refined == 0) return mesh;
  const Topology topology(mesh);
  const RefinedSurface fine = refine(topology, choose_scheme(mesh), mesh.points, which.refined);
  Mesh refined = mesh_from_topology(fine.topology);
  refined.points = fine.values;
  return refined;
}

/// Everything that stays in memory between calls.
struct Reused {
  Topology topology;
  Tessellator tessellator;
  Buffer<float> points;
  Buffer<float> normals;
  Buffer<Index> faces;

  Reused(const Mesh& mesh, const Scheme& scheme, int levels)
      : topology(mesh),
        tessellator(topology, scheme, levels),
        points(3 * static_cast<std::size_t>(tessellator.vertex_count()), 0.0F),
        normals(points.size(), 0.0F),
        faces(static_cast<std::size_t>(tessellator.face_count()) * static_cast<std::size_t>(tessellator.face_size()),
              0) {}

  void set_all() {
    const auto zero = [](auto& buffer) {
      parallel_for(
          static_cast<std::ptrdiff_t>(buffer.size()),
          [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            std::memset(&buffer[begin], 0, sizeof(buffer[0]) * static_cast<std::size_t>(end - begin));
          },
          std::ptrdiff_t{1} << 18);
    };
    zero(points);
    zero(faces);
  }
};

/// The bytes of the resulting points and faces, without the memory used to compute them.
double output_bytes(const Tessellator& tessellator) {
  return 12.0 * tessellator.vertex_count() + 4.0 * tessellator.face_size() * tessellator.face_count();
}

std::string milliseconds(double seconds) { return number(1e3 * seconds, 3); }

/// Starts from an index list in fresh memory. Batten's time comes first, then each peer's as a multiple of it.
void add_fresh(MarkdownTable& table, const Case& which) {
  const Mesh mesh = load(which);
  const Scheme scheme = choose_scheme(mesh);
  const bool tagged = !mesh.creases.empty() || !mesh.corners.empty();
  std::size_t faces = 0;
  std::vector<PeerWork> works{{"Batten", [&] {
                                 const Topology topology(mesh);
                                 const auto result = tessellate<float>(topology, scheme, mesh.points, which.levels);
                                 faces = result.faces.size() / static_cast<std::size_t>(result.face_size);
                               }}};
  works.push_back(opensubdiv_refine(mesh, scheme, which.levels));
  if (!tagged) {
    for (const auto& peers : {openmesh_refine(mesh, scheme, which.levels), cgal_refine(mesh, scheme, which.levels),
                              vtk_refine(mesh, scheme, which.levels)}) {
      works.insert(works.end(), peers.begin(), peers.end());
    }
  }
  std::vector<std::function<void()>> calls;
  for (const PeerWork& each : works) calls.push_back(each.work);
  const std::vector<double> seconds = in_turn(calls, kRounds);
  std::string others;
  for (std::size_t i = 1; i < works.size(); ++i) {
    others += (i > 1 ? ", " : "") + works[i].name + " " + milliseconds(seconds[i]) + " (" +
              number(seconds[i] / seconds[0], 3) + "x)";
  }
  const Topology topology(mesh);
  const double output = output_bytes(Tessellator(topology, scheme, which.levels));
  const std::string memory =
      number(peak_growth(works[0].work) / output, 3) + ", " + number(peak_growth(works[1].work) / output, 3);
  table.add({which.model + (which.refined > 0 ? ", refined " + std::to_string(which.refined) + "x" : ""),
             std::string(scheme.kind == SchemeKind::Loop ? "Loop" : "Catmull-Clark") + (tagged ? ", creases" : ""),
             std::to_string(mesh.face_count()), std::to_string(which.levels), number(1e-6 * static_cast<double>(faces)),
             milliseconds(seconds[0]), others, memory});
}

/// Writes into existing memory, with the connectivity built beforehand.
void add_reused(MarkdownTable& table, const Case& which) {
  const Mesh mesh = load(which);
  const Scheme scheme = choose_scheme(mesh);
  Reused reused(mesh, scheme, which.levels);
  std::vector<PeerWork> works{
      {"points", [&] { reused.tessellator.refined<float>(mesh.points, reused.points); }},
      {"faces", [&] { reused.tessellator.faces(reused.faces); }},
      {"limit", [&] { reused.tessellator.limit<float>(mesh.points, reused.points); }},
      {"normals", [&] { reused.tessellator.limit<float>(mesh.points, reused.points, reused.normals); }},
      {"memset", [&] { reused.set_all(); }}};
  for (PeerWork& peer : opensubdiv_points(mesh, scheme, which.levels)) works.push_back(std::move(peer));
  std::vector<std::function<void()>> calls;
  for (const PeerWork& each : works) calls.push_back(each.work);
  const std::vector<double> s = in_turn(calls, kRounds);
  const double vertices = reused.tessellator.vertex_count();
  const auto per_vertex = [&](double seconds) { return number(1e9 * seconds / vertices, 3); };
  table.add({which.model, std::to_string(which.levels), per_vertex(s[0]), number((s[0] + s[1]) / s[4], 3),
             number((s[3] + s[1]) / (s[0] + s[1]), 3), per_vertex(s[5]) + " (" + number(s[5] / s[0], 3) + "x)",
             per_vertex(s[6]) + " (" + number(s[6] / s[0], 3) + "x)"});
}

}  // namespace

std::string jets_section() {
  MarkdownTable table({"mesh", "scheme", "faces", "Batten, ns", "Bfr, ns", "ratio"});
  add_jets(table, "spot-quads", load({"spot-quads", 0, 0}), SchemeKind::CatmullClark);
  add_jets(table, "beast, refined", load({"beast", 1, 0}), SchemeKind::CatmullClark);
  add_jets(table, "fandisk, refined", load({"fandisk", 1, 0}), SchemeKind::CatmullClark);
  add_jets(table, "spot", load({"spot", 0, 0}), SchemeKind::Loop);
  add_jets(table, "nefertiti", load({"nefertiti", 0, 0}), SchemeKind::Loop);
  return "Point, first and second derivatives at 200,000 random places, face by face, in doubles, one thread, "
         "processor "
         "time; surfaces made\nbeforehand. Next to extraordinary vertices Bfr has an approximation where ours is "
         "exact.\n\n" +
         table.text();
}

std::string butterfly_section() {
  const int levels = 4;
  const Mesh mesh = load({"spot", 0, levels});
  Scheme loop;
  loop.kind = SchemeKind::Loop;
  Scheme butterfly;
  butterfly.kind = SchemeKind::ModifiedButterfly;
  const auto ours = [&](const Scheme& scheme) {
    return [&mesh, scheme] { tessellate<float>(Topology(mesh), scheme, mesh.points, levels); };
  };
  std::vector<PeerWork> works{{"Batten, Modified Butterfly", ours(butterfly)}, {"Batten, Loop", ours(loop)}};
  for (const auto& peers : {openmesh_refine(mesh, butterfly, levels), vtk_refine(mesh, butterfly, levels)}) {
    for (const PeerWork& peer : peers) works.push_back({peer.name + ", Modified Butterfly", peer.work});
  }
  std::vector<std::function<void()>> calls;
  for (const PeerWork& each : works) calls.push_back(each.work);
  const std::vector<double> seconds = in_turn(calls, kRounds);
  MarkdownTable table({"program", "ms", "of ours"});
  for (std::size_t i = 0; i < works.size(); ++i) {
    table.add({works[i].name, milliseconds(seconds[i]), number(seconds[i] / seconds[0], 3) + "x"});
  }
  return "spot, " + std::to_string(mesh.face_count()) + " triangles, to level 4, " +
         number(256e-6 * mesh.face_count()) +
         " million: from an index list in memory to points in floats and faces in fresh memory, in\nturn. OpenMesh and "
         "VTK run on one thread, ours on all.\n\n" +
         table.text();
}

std::string peers_section() {
  MarkdownTable fresh({"mesh", "scheme", "faces", "levels", "million faces out", "Batten, ms", "others, ms",
                       "peak memory, of the output: Batten, OpenSubdiv"});
  for (const Case& which : {Case{"spot-quads", 0, 5}, Case{"armorguy", 0, 4}, Case{"t-rex", 0, 4}, Case{"beast", 0, 3},
                            Case{"beast", 2, 1}, Case{"spot", 0, 4}}) {
    add_fresh(fresh, which);
  }
  MarkdownTable reused({"mesh", "levels", "points, ns a vertex", "points and faces, of a memset",
                        "with limits and normals, of without", "OpenSubdiv PrimvarRefiner, ns a vertex",
                        "OpenSubdiv cascaded stencils, ns a vertex"});
  for (const Case& which :
       {Case{"spot-quads", 0, 5}, Case{"armorguy", 0, 4}, Case{"beast", 0, 3}, Case{"spot", 0, 4}}) {
    add_reused(reused, which);
  }
  return "From an index list in memory to refined points in floats and faces in fresh memory. OpenSubdiv: create, "
         "refine, "
         "interpolate;\none thread, since none of its refinement is threaded.\n\n" +
         fresh.text() +
         "\nInto memory that is there already, connectivity kept. OpenSubdiv's stencils as Debian builds them, on one "
         "thread,\nfour floats a point.\n\n" +
         reused.text();
}

}  // namespace batten::bench

int main(int argc, char** argv) {
  using namespace batten::bench;
  if (std::getenv("BATTEN_DATA") == nullptr) {
    std::fprintf(stderr, "set BATTEN_DATA to the folder of the test data, whose meshes these figures are about\n");
    return 1;
  }
  const std::string which = argc > 2 ? argv[2] : "";
  const std::string tunables = std::getenv("GLIBC_TUNABLES") == nullptr ? "" : std::getenv("GLIBC_TUNABLES");
  const bool huge = tunables.find("hugetlb=1") != std::string::npos;
  std::string name = "peers";
  std::string head = "## Refinement beside other libraries";
  if (which == "jets") {
    name = "peers, jets";
    head = "## Jets of the limit surface beside OpenSubdiv's Bfr";
  } else if (which == "butterfly") {
    name = "peers, butterfly";
    head = "## Modified Butterfly beside other libraries";
  } else if (huge) {
    name = "peers, huge pages";
    head = "## Refinement, with huge pages for everyone (GLIBC_TUNABLES=glibc.malloc.hugetlb=1)";
  }
  const std::string section = which == "jets"        ? jets_section()
                              : which == "butterfly" ? butterfly_section()
                                                     : peers_section();
  const std::string part = head + "\n\n" + machine() + "\n" + section + "\n";
  std::printf("%s", part.c_str());
  if (argc > 1) write_part(argv[1], name, part);
}
