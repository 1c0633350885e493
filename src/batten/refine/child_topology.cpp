#include "batten/refine/child_topology.h"

#include <limits>
#include <string>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

/// The half of half-edge h's edge at h's origin: 2e at the origin of the edge's lower half-edge, 2e + 1 at its end.
Index half_at_origin(const Topology& parent, Index h) {
  const Index e = parent.edge(h);
  return 2 * e + (parent.edge_half_edge(e) == h ? 0 : 1);
}
Index half_at_destination(const Topology& parent, Index h) {
  const Index e = parent.edge(h);
  return 2 * e + (parent.edge_half_edge(e) == h ? 1 : 0);
}

Buffer<Index> uniform_offsets(Index faces, Index size) {
  Buffer<Index> offsets(static_cast<std::size_t>(faces) + 1);
  parallel_for(static_cast<std::ptrdiff_t>(offsets.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t f = begin; f < end; ++f) offsets[f] = static_cast<Index>(f) * size;
  });
  return offsets;
}

void resize_half_edges(TopologyTables& child, Index count) {
  const auto size = static_cast<std::size_t>(count);
  child.origins.resize(size);
  child.twins.resize(size);
  child.faces.resize(size);
  child.edges.resize(size);
}

void number_edge_half_edges(TopologyTables& child, Index edge_count, const Progress& progress) {
  child.edge_half_edges.resize(static_cast<std::size_t>(edge_count));
  const auto number = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto h = static_cast<Index>(begin); h < end; ++h) {
      if (child.twins[h] < 0 || h < child.twins[h]) child.edge_half_edges[child.edges[h]] = h;
    }
  };
  parallel_for(static_cast<std::ptrdiff_t>(child.twins.size()), number, kDefaultBlock, progress);
}

/// Quad h of half-edge h has the corners v, edge point, face point and the previous edge's point.
void fill_quads(const Topology& parent, TopologyTables& child, const Progress& progress) {
  const Index v_count = parent.vertex_count();
  const Index e_count = parent.edge_count();
  const auto fill = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const Index first = parent.face_begin(f);
      const Index last = parent.face_end(f) - 1;
      for (Index h = first; h <= last; ++h) {
        const Index p = h == first ? last : h - 1;
        const Index n = h == last ? first : h + 1;
        const Index twin = parent.twin(h);
        const Index twin_p = parent.twin(p);
        const Index q = 4 * h;
        child.origins[q] = parent.origin(h);
        child.origins[q + 1] = v_count + parent.edge(h);
        child.origins[q + 2] = v_count + e_count + f;
        child.origins[q + 3] = v_count + parent.edge(p);
        child.twins[q] = twin < 0 ? -1 : 4 * parent.next(twin) + 3;
        child.twins[q + 1] = 4 * n + 2;
        child.twins[q + 2] = 4 * p + 1;
        child.twins[q + 3] = twin_p < 0 ? -1 : 4 * twin_p;
        child.edges[q] = half_at_origin(parent, h);
        child.edges[q + 1] = 2 * e_count + h;
        child.edges[q + 2] = 2 * e_count + p;
        child.edges[q + 3] = half_at_destination(parent, p);
        for (Index i = 0; i < 4; ++i) child.faces[q + i] = h;
      }
    }
  };
  parallel_for(parent.face_count(), fill, kDefaultBlock, progress);
}

/// Triangle 4f + k at corner k has the corners v_k, edge k and edge k-1; triangle 4f + 3 has the edges 0, 1, 2.
void fill_triangles(const Topology& parent, TopologyTables& child, const Progress& progress) {
  const Index v_count = parent.vertex_count();
  const Index e_count = parent.edge_count();
  // Half-edge h = 3f + k of the parent lies on two child triangles: it is the first side of 4f + k and the third side
  // of 4f + k + 1.
  const auto corner_triangle = [](Index h) { return 4 * (h / 3) + h % 3; };
  const auto fill = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const Index middle = 3 * (4 * f + 3);
      for (Index k = 0; k < 3; ++k) {
        const Index h = 3 * f + k;
        const Index p = 3 * f + (k + 2) % 3;
        const Index twin = parent.twin(h);
        const Index twin_p = parent.twin(p);
        const Index t = 3 * (4 * f + k);
        child.origins[t] = parent.origin(h);
        child.origins[t + 1] = v_count + parent.edge(h);
        child.origins[t + 2] = v_count + parent.edge(p);
        child.origins[middle + k] = v_count + parent.edge(h);
        child.twins[t] = twin < 0 ? -1 : 3 * corner_triangle(parent.next(twin)) + 2;
        child.twins[t + 1] = middle + (k + 2) % 3;
        child.twins[t + 2] = twin_p < 0 ? -1 : 3 * corner_triangle(twin_p);
        child.twins[middle + k] = 3 * (4 * f + (k + 1) % 3) + 1;
        child.edges[t] = half_at_origin(parent, h);
        child.edges[t + 1] = 2 * e_count + h;  // the side that cuts off corner k
        child.edges[t + 2] = half_at_destination(parent, p);
        child.edges[middle + k] = 2 * e_count + 3 * f + (k + 1) % 3;
        for (Index i = 0; i < 3; ++i) child.faces[t + i] = 4 * f + k;
        child.faces[middle + k] = 4 * f + 3;
      }
    }
  };
  parallel_for(parent.face_count(), fill, kDefaultBlock, progress);
}

/// A child vertex's fan starts where its parent's does. A new vertex's fan starts at the boundary if there is one.
void start_fans(const Topology& parent, const Scheme& scheme, TopologyTables& child) {
  const Index v_count = parent.vertex_count();
  const Index e_count = parent.edge_count();
  const bool quads = scheme.kind == SchemeKind::CatmullClark;
  const auto first_child = [&](Index h) { return quads ? 4 * h : 3 * (4 * (h / 3) + h % 3); };
  child.vertex_half_edges.resize(static_cast<std::size_t>(child.vertex_count));
  parallel_for(v_count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      const Index h = parent.vertex_half_edge(static_cast<Index>(v));
      child.vertex_half_edges[v] = h < 0 ? -1 : first_child(h);
    }
  });
  parallel_for(e_count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto e = static_cast<Index>(begin); e < end; ++e) {
      // The half that leaves the edge point towards the end of the lower half-edge is the last side of the next child.
      const Index h = parent.edge_half_edge(e);
      const Index n = parent.next(h);
      child.vertex_half_edges[v_count + e] = quads ? 4 * n + 3 : first_child(n) + 2;
    }
  });
  if (!quads) return;
  parallel_for(parent.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      child.vertex_half_edges[v_count + e_count + f] = 4 * parent.face_begin(f) + 2;
    }
  });
}

void pass_tags_on(const Topology& parent, const Scheme& scheme, TopologyTables& child) {
  if (parent.has_corners()) {
    child.vertex_sharpness.assign(static_cast<std::size_t>(child.vertex_count), 0.0F);
    for (Index v = 0; v < parent.vertex_count(); ++v) {
      child.vertex_sharpness[v] = subdivided_sharpness(parent.vertex_sharpness(v));
    }
  }
  if (parent.has_creases()) {
    const CreaseMethod method = is_interpolating(scheme.kind) ? CreaseMethod::Uniform : scheme.crease_method;
    child.edge_sharpness.assign(child.edge_half_edges.size(), 0.0F);
    parallel_for(parent.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      VertexRing ring;
      for (auto v = static_cast<Index>(begin); v < end; ++v) {
        if (parent.is_isolated(v)) continue;
        gather_ring(parent, v, ring);
        const SemiSharpEdges around = semi_sharp_edges(ring.sharpness);
        for (std::size_t i = 0; i < ring.edges.size(); ++i) {
          const Index e = ring.edges[i];
          const bool at_origin = parent.origin(parent.edge_half_edge(e)) == v;
          child.edge_sharpness[2 * e + (at_origin ? 0 : 1)] = subdivided_sharpness(ring.sharpness[i], around, method);
        }
      }
    });
  }
  if (parent.has_holes()) {
    child.holes.assign(child.face_offsets.size() - 1, 0);
    for (Index f = 0; f < parent.face_count(); ++f) {
      if (!parent.is_hole(f)) continue;
      const Index first = scheme.kind == SchemeKind::CatmullClark ? parent.face_begin(f) : 4 * f;
      const Index count = scheme.kind == SchemeKind::CatmullClark ? parent.face_size(f) : 4;
      for (Index i = 0; i < count; ++i) child.holes[first + i] = 1;
    }
  }
}

}  // namespace

void require_triangles(const Topology& topology, const Scheme& scheme) {
  const bool any_face = scheme.kind == SchemeKind::CatmullClark;
  if (any_face || topology.uniform_face_size() == 3 || topology.face_count() == 0) return;
  Index f = 0;
  while (topology.face_size(f) == 3) ++f;
  throw Error(ErrorCode::NotTriangles,
              std::string(scheme_name(scheme.kind)) + " subdivision needs triangles, but face " + std::to_string(f) +
                  " has " + std::to_string(topology.face_size(f)) + " corners; triangulate it or take Catmull-Clark");
}

Topology child_topology(const Topology& parent, const Scheme& scheme, const Progress& progress) {
  const bool quads = scheme.kind == SchemeKind::CatmullClark;
  require_triangles(parent, scheme);
  const std::int64_t half_edges = std::int64_t{4} * parent.half_edge_count();
  if (half_edges > std::numeric_limits<Index>::max()) {
    throw Error(ErrorCode::TooLarge, "one more level would have " + std::to_string(half_edges) +
                                         " half-edges, more than 2^31 - 1; refine less");
  }
  TopologyTables child;
  const Index faces = quads ? parent.half_edge_count() : 4 * parent.face_count();
  child.vertex_count = parent.vertex_count() + parent.edge_count() + (quads ? parent.face_count() : 0);
  child.uniform_face_size = quads ? 4 : 3;
  child.face_offsets = uniform_offsets(faces, child.uniform_face_size);
  resize_half_edges(child, faces * child.uniform_face_size);
  if (quads) {
    fill_quads(parent, child, progress_within(progress, 0.0, 0.6));
  } else {
    fill_triangles(parent, child, progress_within(progress, 0.0, 0.6));
  }
  number_edge_half_edges(child, 2 * parent.edge_count() + parent.half_edge_count(),
                         progress_within(progress, 0.6, 0.8));
  start_fans(parent, scheme, child);
  report_progress(progress, 0.9);
  pass_tags_on(parent, scheme, child);
  return Topology::from_tables(std::move(child));
}

}  // namespace batten
