#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>

#include <memory>

#include "bench/peers.h"
#include "tests/conformance/opensubdiv_oracle.h"

namespace batten::bench {

namespace {

using namespace OpenSubdiv;

template <int K>
struct FloatPoint {
  float x[K];
  void Clear() {
    for (float& number : x) number = 0.0F;
  }
  void AddWithWeight(const FloatPoint& other, float weight) {
    for (int c = 0; c < K; ++c) x[c] += weight * other.x[c];
  }
};

template <int K>
std::vector<FloatPoint<K>> float_points(const Mesh& mesh) {
  std::vector<FloatPoint<K>> points(static_cast<std::size_t>(mesh.vertex_count()));
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    for (int c = 0; c < 3; ++c) points[v].x[c] = static_cast<float>(mesh.points(v, c));
  }
  return points;
}

void refine_uniformly(Far::TopologyRefiner& refiner, int levels) {
  refiner.RefineUniform(Far::TopologyRefiner::UniformOptions(levels));
}

void interpolate(const Far::TopologyRefiner& refiner, int levels, const FloatPoint<3>* control, FloatPoint<3>* out) {
  const Far::PrimvarRefiner primvar(refiner);
  const FloatPoint<3>* from = control;
  for (int level = 1; level <= levels; ++level) {
    primvar.Interpolate(level, from, out);
    from = out;
    out += refiner.GetLevel(level).GetNumVertices();
  }
}

}  // namespace

PeerWork opensubdiv_refine(const Mesh& mesh, const Scheme& scheme, int levels) {
  auto control = std::make_shared<std::vector<FloatPoint<3>>>(float_points<3>(mesh));
  return {"OpenSubdiv", [&mesh, scheme, levels, control] {
            const auto refiner = test::oracle_refiner(mesh, scheme);
            refine_uniformly(*refiner, levels);
            std::vector<FloatPoint<3>> out(
                static_cast<std::size_t>(refiner->GetNumVerticesTotal() - refiner->GetLevel(0).GetNumVertices()));
            interpolate(*refiner, levels, control->data(), out.data());
          }};
}

std::vector<PeerWork> opensubdiv_points(const Mesh& mesh, const Scheme& scheme, int levels) {
  std::shared_ptr<Far::TopologyRefiner> refiner(test::oracle_refiner(mesh, scheme).release());
  refine_uniformly(*refiner, levels);
  auto control = std::make_shared<std::vector<FloatPoint<3>>>(float_points<3>(mesh));
  auto out = std::make_shared<std::vector<FloatPoint<3>>>(
      static_cast<std::size_t>(refiner->GetNumVerticesTotal() - refiner->GetLevel(0).GetNumVertices()));
  Far::StencilTableFactory::Options options;
  options.generateIntermediateLevels = true;
  options.factorizeIntermediateLevels = false;
  options.generateOffsets = true;
  const std::shared_ptr<const Far::StencilTable> stencils(Far::StencilTableFactory::Create(*refiner, options));
  auto all = std::make_shared<std::vector<FloatPoint<4>>>(float_points<4>(mesh));
  all->resize(static_cast<std::size_t>(refiner->GetNumVerticesTotal()));
  return {{"OpenSubdiv, PrimvarRefiner",
           [refiner, control, out, levels] { interpolate(*refiner, levels, control->data(), out->data()); }},
          {"OpenSubdiv, cascaded stencils", [refiner, stencils, all, levels] {
             // The stencils of a level count from the first point of the level before. The evaluator's own start is
             // left at 0, because 3.5 adds it twice for four floats per point.
             int first = 0;
             int before = 0;
             for (int level = 1; level <= levels; ++level) {
               const int count = refiner->GetLevel(level).GetNumVertices();
               const int start = refiner->GetLevel(0).GetNumVertices() + first;
               const auto skipped = stencils->GetOffsets()[static_cast<std::size_t>(first)];
               float* data = all->front().x;
               Osd::CpuEvaluator::EvalStencils(
                   data, Osd::BufferDescriptor(4 * before, 4, 4), data, Osd::BufferDescriptor(4 * start, 4, 4),
                   stencils->GetSizes().data() + first, stencils->GetOffsets().data(),
                   stencils->GetControlIndices().data() + skipped, stencils->GetWeights().data() + skipped, 0, count);
               before = start;
               first += count;
             }
           }}};
}

}  // namespace batten::bench
