#include "batten/patch/surface_patches.h"

#include <algorithm>
#include <mutex>
#include <optional>

#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/patch/face_types.h"
#include "batten/patch/pieces.h"
#include "batten/patch/ring_types.h"
#include "batten/refine/child_topology.h"
#include "batten/refine/refined_rows.h"
#include "batten/refine/refinement.h"

namespace batten {

struct SurfacePatches::Parts {
  /// Pieces and the types of those that are rings.
  struct Cut {
    Pieces pieces;
    RingTypes types;
    Buffer<Index> type_of_shared;  ///< of each shared ring of the pieces

    Cut(const Topology& base, const Scheme& base_scheme, const Scheme& scheme)
        : pieces(base, base_scheme, kRingPieceLevels, Pieces::Rest::Rings), types(scheme) {
      FaceRing ring;
      for (const Pieces::SharedRing& shared : pieces.shared_rings()) {
        ring.gather(shared.topology, base_scheme, 0, shared.poles, Poles::kWidth);
        type_of_shared.push_back(types.type_of(shared.topology, ring));
      }
    }
  };

  Topology topology;
  Scheme scheme;
  Scheme base_scheme;
  std::optional<Refinement> first;
  std::optional<RefinementPullback> pullback;
  Topology base;
  Buffer<std::uint8_t> holes;
  mutable std::once_flag cut_once;
  mutable std::unique_ptr<const Cut> cut;
  mutable std::once_flag faces_once;
  mutable std::unique_ptr<const FaceTypes> faces;

  Parts(const Topology& topology_in, const Scheme& scheme_in, const Progress& progress)
      : topology(topology_in), scheme(scheme_in), base_scheme(scheme_in.after_first_step()), base(topology_in) {
    if (needs_first_step(topology, scheme)) {
      first.emplace(topology, scheme, std::vector<double>{}, progress);
      pullback.emplace(topology, scheme);
      base = first->child();
    }
    find_holes();
  }

  /// Quad h of a first refinement lies in the face of corner h.
  void find_holes() {
    const Buffer<std::uint8_t> of_control = surface_holes(topology, scheme);
    if (std::find(of_control.begin(), of_control.end(), 1) == of_control.end()) return;
    holes.resize(static_cast<std::size_t>(base.face_count()));
    for (Index f = 0; f < base.face_count(); ++f) holes[f] = of_control[first ? topology.face(f) : f];
  }

  const Cut& cut_into_pieces() const {
    std::call_once(cut_once, [&] {
      require_narrow_sharp_fans(base, base_scheme, kRingPieceLevels);
      cut = std::make_unique<const Cut>(base, base_scheme, scheme);
    });
    return *cut;
  }
};

SurfacePatches::SurfacePatches(const Topology& topology, const Scheme& scheme, const Progress& progress) {
  require_triangles(topology, scheme);
  parts_ = std::make_shared<const Parts>(topology, scheme, progress);
}

const Topology& SurfacePatches::topology() const { return parts_->topology; }
const Scheme& SurfacePatches::scheme() const { return parts_->scheme; }
const Topology& SurfacePatches::base() const { return parts_->base; }
const Scheme& SurfacePatches::base_scheme() const { return parts_->base_scheme; }
bool SurfacePatches::has_first_step() const { return parts_->first.has_value(); }
const Buffer<std::uint8_t>& SurfacePatches::holes() const { return parts_->holes; }

int SurfacePatches::patch_size() const { return batten::patch_size(quads()); }

Index SurfacePatches::control_face(Index base_face) const {
  return has_first_step() ? parts_->topology.face(base_face) : base_face;
}

Values SurfacePatches::base_values(ConstValuesRef control, const Progress& progress) const {
  if (has_first_step()) return parts_->first->apply(control, progress);
  require_vertex_rows(parts_->topology, control);
  return control;
}

std::vector<std::pair<Index, double>> SurfacePatches::by_control(std::vector<std::pair<Index, double>> of_base) const {
  if (has_first_step()) return (*parts_->pullback)(of_base);
  merge(of_base);
  return of_base;
}

const Pieces& SurfacePatches::pieces() const { return parts_->cut_into_pieces().pieces; }
const RingTypes& SurfacePatches::ring_types() const { return parts_->cut_into_pieces().types; }
Index SurfacePatches::ring_type(const Piece& piece) const { return ring_type(piece.shared_ring); }
Index SurfacePatches::ring_type(std::int32_t shared_ring) const {
  return parts_->cut_into_pieces().type_of_shared[shared_ring];
}

const FaceTypes& SurfacePatches::face_types() const {
  const Parts& parts = *parts_;
  std::call_once(parts.faces_once, [&] {
    require_narrow_sharp_fans(parts.base, parts.base_scheme, 0);
    parts.faces = std::make_unique<const FaceTypes>(parts.base, parts.base_scheme);
  });
  return *parts.faces;
}

void require_control_points(const Topology& topology, ConstValuesRef control) {
  require_vertex_rows(topology, control);
  if (control.cols() != 3) throw Error(ErrorCode::BadShape, "a limit surface has points of three columns");
  require_finite(control, "control points");
}

}  // namespace batten
