/// Jets of the limit surface beside OpenSubdiv's Bfr.
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>

#include <ctime>
#include <random>

#include "batten/parallel/parallel.h"
#include "batten/patch/regular_patch.h"
#include "batten/surface/limit_surface.h"
#include "bench/bench.h"
#include "bench/peers.h"
#include "tests/conformance/opensubdiv_oracle.h"

namespace batten::bench {

namespace {

namespace Bfr = OpenSubdiv::Bfr;
constexpr int kRounds = 5;
constexpr std::size_t kPlaces = 200000;

/// The surfaces of all faces and their points, built once.
class BfrSurfaces {
 public:
  BfrSurfaces(const Mesh& mesh, const Scheme& scheme)
      : refiner_(test::oracle_refiner(mesh, scheme)),
        factory_(*refiner_),
        surfaces_(static_cast<std::size_t>(mesh.face_count())) {
    std::size_t size = 0;
    for (std::size_t f = 0; f < surfaces_.size(); ++f) {
      factory_.InitVertexSurface(static_cast<int>(f), &surfaces_[f]);
      starts_.push_back(size);
      size += 3 * static_cast<std::size_t>(surfaces_[f].GetNumPatchPoints());
    }
    points_.resize(size);
    for (std::size_t f = 0; f < surfaces_.size(); ++f) {
      surfaces_[f].PreparePatchPoints(mesh.points.data(), 3, points_.data() + starts_[f], 3);
    }
  }

  void jets(const std::vector<SurfacePlace>& places, std::vector<Jet>& jets) const {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double uv[2] = {places[i].u, places[i].v};
      const auto face = static_cast<std::size_t>(places[i].face);
      Jet& jet = jets[i];
      surfaces_[face].Evaluate(uv, points_.data() + starts_[face], 3, jet.point.data(), jet.du.data(), jet.dv.data(),
                               jet.duu.data(), jet.duv.data(), jet.dvv.data());
    }
  }

 private:
  std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner_;
  Bfr::RefinerSurfaceFactory<> factory_;  ///< the surfaces refer to its cache
  std::vector<Bfr::Surface<double>> surfaces_;
  std::vector<std::size_t> starts_;
  std::vector<double> points_;
};

/// The least processor time of several runs. The load of the machine changes it little.
double processor_seconds(const std::function<void()>& work) {
  double least = 1e9;
  for (int round = 0; round < kRounds; ++round) {
    const std::clock_t start = std::clock();
    work();
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

/// Random places, face by face, in the part of each face next to its first corner.
std::vector<SurfacePlace> random_places(const std::vector<Index>& faces, bool quads, double part) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> side(0.0, part);
  std::vector<SurfacePlace> places;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    double u = side(random);
    double v = side(random);
    if (!quads && u + v > part) {
      u = part - u;
      v = part - v;
    }
    places.push_back({faces[i * faces.size() / kPlaces], u, v});
  }
  return places;
}

}  // namespace

void add_jets(MarkdownTable& table, const std::string& name, const Mesh& mesh, SchemeKind kind) {
  const ThreadLimit one(1);
  Scheme scheme;
  scheme.kind = kind;
  const bool quads = kind == SchemeKind::CatmullClark;
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme, mesh.points);
  const BfrSurfaces bfr(mesh, scheme);
  const PatchFinder finder(topology, scheme);
  std::vector<Index> faces[2];
  RegularPatch patch;
  for (Index f = 0; f < topology.face_count(); ++f) {
    faces[finder.find(topology.face_begin(f), patch) ? 0 : 1].push_back(f);
  }
  const struct {
    const char* name;
    int kind;
    double part;
  } samples[] = {{"regular", 0, 1.0},
                 {"irregular", 1, 1.0},
                 {"irregular, a corner's 1/10", 1, 0.1},
                 {"irregular, a corner's 1/100", 1, 0.01}};
  std::vector<Jet> jets(kPlaces);
  for (const auto& sample : samples) {
    if (faces[sample.kind].size() < 200) continue;
    const std::vector<SurfacePlace> places = random_places(faces[sample.kind], quads, sample.part);
    const double ours = processor_seconds([&] { surface.jets(places, jets); }) / kPlaces;
    const double theirs = processor_seconds([&] { bfr.jets(places, jets); }) / kPlaces;
    table.add({name, quads ? "Catmull-Clark" : "Loop", sample.name, number(1e9 * ours, 3), number(1e9 * theirs, 3),
               number(theirs / ours, 3) + "x"});
  }
  const double count = mesh.face_count();
  const double ours = processor_seconds([&] { const LimitSurface made(topology, scheme, mesh.points); }) / count;
  const double theirs = processor_seconds([&] { const BfrSurfaces made(mesh, scheme); }) / count;
  table.add({name, quads ? "Catmull-Clark" : "Loop", "to build, a face", number(1e9 * ours, 3), number(1e9 * theirs, 3),
             number(theirs / ours, 3) + "x"});
}

}  // namespace batten::bench
