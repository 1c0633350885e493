#include "batten/mesh/topology.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "batten/error.h"
#include "batten/mesh/check.h"
#include "batten/mesh/vertex_fans.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr std::ptrdiff_t kTestedPerBlock = 1 << 13;

/// A half-edge at its origin, for sorting by destination.
struct Spoke {
  Index destination;
  Index half_edge;
  bool operator<(const Spoke& other) const {
    return destination != other.destination ? destination < other.destination : half_edge < other.half_edge;
  }
};

bool has_repeated_vertex(const Index* vertices, Index count) {
  if (count > 16) {
    Buffer<Index> sorted(vertices, vertices + count);
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  }
  for (Index i = 1; i < count; ++i) {
    for (Index j = 0; j < i; ++j) {
      if (vertices[i] == vertices[j]) return true;
    }
  }
  return false;
}

bool offsets_and_indices_hold(const Mesh& mesh, const Progress& progress) {
  constexpr std::size_t kMost = std::numeric_limits<Index>::max();
  if (mesh.face_offsets.empty() || mesh.face_offsets.front() != 0 || mesh.face_vertices.size() > kMost ||
      static_cast<std::size_t>(mesh.face_offsets.back()) != mesh.face_vertices.size()) {
    return false;
  }
  const Index vertex_count = mesh.vertex_count();
  const auto faces_hold = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t f = begin; f < end; ++f) {
      if (mesh.face_offsets[f] < 0 || mesh.face_offsets[f + 1] - std::int64_t{mesh.face_offsets[f]} < 3 ||
          mesh.face_offsets[f + 1] > mesh.face_offsets.back()) {
        return false;
      }
      const Index* vertices = &mesh.face_vertices[mesh.face_offsets[f]];
      const Index size = mesh.face_size(static_cast<Index>(f));
      for (Index i = 0; i < size; ++i) {
        if (vertices[i] < 0 || vertices[i] >= vertex_count) return false;
      }
      if (has_repeated_vertex(vertices, size)) return false;
    }
    return true;
  };
  const auto points_hold = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    return mesh.points.middleRows(begin, end - begin).allFinite();
  };
  return parallel_all_of(mesh.face_count(), faces_hold, kTestedPerBlock, progress) &&
         parallel_all_of(mesh.points.rows(), points_hold, kTestedPerBlock);
}

/// The half-edges that leave each vertex, sorted by destination: spokes[offsets[v] .. offsets[v + 1]).
struct SpokeTable {
  Buffer<Index> offsets;
  Buffer<Spoke> spokes;
};

SpokeTable gather_spokes(TopologyTables& tables, const Progress& progress) {
  const auto vertex_count = static_cast<std::size_t>(tables.vertex_count);
  const auto face_count = static_cast<std::ptrdiff_t>(tables.face_offsets.size()) - 1;
  SpokeTable table;
  table.offsets.assign(vertex_count + 1, 0);
  // Each half-edge's position among those that leave its vertex is stored where its twin will be. Counting once is
  // enough and saves time, since several threads add to the same counters.
  tables.twins.resize(tables.origins.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(tables.origins.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t h = begin; h < end; ++h) tables.twins[h] = atomic_add(table.offsets[tables.origins[h]], 1);
      },
      1 << 14, progress_within(progress, 0.0, 0.3));
  Index sum = 0;
  for (Index& offset : table.offsets) sum += std::exchange(offset, sum);
  table.spokes.resize(tables.origins.size());
  tables.faces.resize(tables.origins.size());
  parallel_for(
      face_count,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t f = begin; f < end; ++f) {
          const Index first = tables.face_offsets[f];
          const Index last = tables.face_offsets[f + 1] - 1;
          for (Index h = first; h <= last; ++h) {
            tables.faces[h] = static_cast<Index>(f);
            const Index slot = table.offsets[tables.origins[h]] + tables.twins[h];
            table.spokes[slot] = {tables.origins[h == last ? first : h + 1], h};
          }
        }
      },
      1 << 13, progress_within(progress, 0.3, 1.0));
  return table;
}

/// Sorts spokes, which makes their order independent of the threads. Returns false if a directed edge occurs twice.
bool sort_spokes(SpokeTable& table, const Progress& progress) {
  const auto sorted = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    bool unique = true;
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      Spoke* first = table.spokes.data() + table.offsets[v];
      Spoke* last = table.spokes.data() + table.offsets[v + 1];
      if (last - first < 2) continue;
      if (last - first > 16) {
        std::sort(first, last);
      } else {
        for (Spoke* i = first + 1; i < last; ++i) {
          const Spoke moved = *i;
          Spoke* hole = i;
          for (; hole > first && moved < hole[-1]; --hole) *hole = hole[-1];
          *hole = moved;
        }
      }
      for (const Spoke* i = first + 1; i < last; ++i) unique = unique && i[-1].destination != i->destination;
    }
    return unique;
  };
  return parallel_all_of(static_cast<std::ptrdiff_t>(table.offsets.size()) - 1, sorted, kTestedPerBlock, progress);
}

Index find_spoke(const SpokeTable& table, Index from, Index to) {
  const Spoke* first = table.spokes.data() + table.offsets[from];
  const Spoke* last = table.spokes.data() + table.offsets[from + 1];
  if (last - first > 16) first = std::lower_bound(first, last, Spoke{to, 0});
  for (; first < last && first->destination <= to; ++first) {
    if (first->destination == to) return first->half_edge;
  }
  return -1;
}

/// Each thread writes the entries of its own vertices' spokes and, at the lower end of each edge, of their twins.
void match_twins(const SpokeTable& table, TopologyTables& tables, const Progress& progress) {
  parallel_for(
      tables.vertex_count,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto v = static_cast<Index>(begin); v < end; ++v) {
          for (Index i = table.offsets[v]; i < table.offsets[v + 1]; ++i) {
            const Spoke spoke = table.spokes[i];
            if (v < spoke.destination) {
              const Index twin = find_spoke(table, spoke.destination, v);
              tables.twins[spoke.half_edge] = twin;
              if (twin >= 0) tables.twins[twin] = spoke.half_edge;
            } else if (find_spoke(table, spoke.destination, v) < 0) {
              tables.twins[spoke.half_edge] = -1;
            }
          }
        }
      },
      1 << 13, progress);
}

/// Finds where each vertex's fan starts. Returns false if one turn does not visit all faces of a vertex.
bool start_fans(const SpokeTable& table, TopologyTables& tables, const Progress& progress) {
  tables.vertex_half_edges.resize(static_cast<std::size_t>(tables.vertex_count));
  const auto fans_hold = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      const Index count = table.offsets[v + 1] - table.offsets[v];
      Index start = count == 0 ? -1 : table.spokes[table.offsets[v]].half_edge;
      for (Index i = table.offsets[v]; i < table.offsets[v + 1]; ++i) {
        const Index h = table.spokes[i].half_edge;
        if (tables.twins[h] < 0) {
          start = h;
          break;
        }
        start = std::min(start, h);
      }
      tables.vertex_half_edges[v] = start;
      Index met = 0;
      for (Index h = start; h >= 0 && met < count;) {
        ++met;
        h = tables.twins[previous_half_edge(tables, h)];
        if (h == start) break;
      }
      if (met != count) return false;
    }
    return true;
  };
  return parallel_all_of(tables.vertex_count, fans_hold, kTestedPerBlock, progress);
}

/// Numbers edges by their lower half-edge, in order.
void number_edges(TopologyTables& tables, const Progress& progress) {
  constexpr std::ptrdiff_t kBlock = 1 << 15;
  const auto count = static_cast<std::ptrdiff_t>(tables.origins.size());
  const auto owns = [&](std::ptrdiff_t h) { return tables.twins[h] < 0 || h < tables.twins[h]; };
  std::vector<Index> firsts(static_cast<std::size_t>(block_count(count, kBlock)) + 1, 0);
  parallel_for(
      count,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Index owned = 0;
        for (std::ptrdiff_t h = begin; h < end; ++h) owned += owns(h) ? 1 : 0;
        firsts[begin / kBlock + 1] = owned;
      },
      kBlock, progress_within(progress, 0.0, 0.3));
  for (std::size_t i = 1; i < firsts.size(); ++i) firsts[i] += firsts[i - 1];
  tables.edges.resize(tables.origins.size());
  tables.edge_half_edges.resize(static_cast<std::size_t>(firsts.back()));
  parallel_for(
      count,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Index edge = firsts[begin / kBlock];
        for (std::ptrdiff_t h = begin; h < end; ++h) {
          if (!owns(h)) continue;
          tables.edges[h] = edge;
          if (tables.twins[h] >= 0) tables.edges[tables.twins[h]] = edge;
          tables.edge_half_edges[edge++] = static_cast<Index>(h);
        }
      },
      kBlock, progress_within(progress, 0.3, 1.0));
}

/// Returns false if a tag names a missing element or is not a number.
bool apply_tags(const Mesh& mesh, const SpokeTable& table, TopologyTables& tables) {
  const auto exists = [&](Index v) { return v >= 0 && v < tables.vertex_count; };
  const auto as_float = [](double sharpness) { return static_cast<float>(std::clamp(sharpness, 0.0, 10.0)); };
  if (!mesh.creases.empty()) tables.edge_sharpness.assign(tables.edge_half_edges.size(), 0.0F);
  for (const Crease& crease : mesh.creases) {
    if (!exists(crease.a) || !exists(crease.b) || !std::isfinite(crease.sharpness)) return false;
    Index h = find_spoke(table, crease.a, crease.b);
    if (h < 0) h = find_spoke(table, crease.b, crease.a);
    if (h < 0) return false;
    tables.edge_sharpness[tables.edges[h]] = as_float(crease.sharpness);
  }
  if (!mesh.corners.empty()) tables.vertex_sharpness.assign(static_cast<std::size_t>(tables.vertex_count), 0.0F);
  for (const Corner& corner : mesh.corners) {
    if (!exists(corner.vertex) || !std::isfinite(corner.sharpness)) return false;
    tables.vertex_sharpness[corner.vertex] = as_float(corner.sharpness);
  }
  if (!mesh.holes.empty()) tables.holes.assign(static_cast<std::size_t>(mesh.face_count()), 0);
  for (const Index face : mesh.holes) {
    if (face < 0 || face >= mesh.face_count()) return false;
    tables.holes[face] = 1;
  }
  return true;
}

Index common_face_size(const Buffer<Index>& offsets) {
  if (offsets.size() < 2) return 0;
  const Index size = offsets[1];
  const auto same = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t f = begin; f < end; ++f) {
      if (offsets[f + 1] - offsets[f] != size) return false;
    }
    return true;
  };
  return parallel_all_of(static_cast<std::ptrdiff_t>(offsets.size()) - 1, same, kTestedPerBlock) ? size : 0;
}

bool build(const Mesh& mesh, TopologyTables& tables, const Progress& progress) {
  const auto part = [&](double begin, double end) { return progress_within(progress, begin, end); };
  if (!offsets_and_indices_hold(mesh, part(0.0, 0.1))) return false;
  tables.vertex_count = mesh.vertex_count();
  tables.face_offsets = mesh.face_offsets;
  tables.origins = mesh.face_vertices;
  tables.uniform_face_size = common_face_size(tables.face_offsets);
  SpokeTable table = gather_spokes(tables, part(0.2, 0.45));
  if (!sort_spokes(table, part(0.45, 0.55))) return false;
  match_twins(table, tables, part(0.55, 0.75));
  if (!start_fans(table, tables, part(0.75, 0.9))) return false;
  number_edges(tables, part(0.9, 1.0));
  return apply_tags(mesh, table, tables);
}

}  // namespace

Topology::Topology(const Mesh& mesh, const Progress& progress) {
  auto tables = std::make_shared<TopologyTables>();
  tables_ = tables;
  if (mesh.points.rows() > std::numeric_limits<Index>::max()) {
    throw Error(ErrorCode::TooLarge, "the mesh has more than 2^31 - 1 vertices; split it");
  }
  if (build(mesh, *tables, progress)) return;
  const std::vector<MeshProblem> problems = check(mesh);
  if (problems.empty())
    throw Error(ErrorCode::BadShape, "the mesh was refused for a reason that check() does not know");
  throw Error(problems.front().kind, problems.front().messages.front());
}

Topology Topology::from_tables(TopologyTables tables) {
  return Topology(std::make_shared<const TopologyTables>(std::move(tables)));
}

Index Topology::vertex_face_count(Index vertex) const {
  Index count = 0;
  for_each_outgoing(vertex, [&](Index /*h*/) { ++count; });
  return count;
}

void require_vertex_rows(const Topology& topology, ConstValuesRef values) {
  if (values.rows() == topology.vertex_count()) return;
  throw Error(ErrorCode::BadShape, "there are " + std::to_string(values.rows()) + " rows of values, but the mesh has " +
                                       std::to_string(topology.vertex_count()) + " vertices; give one row a vertex");
}

namespace {

/// Trees of vertices whose roots are the lowest of what is joined so far. Several threads may join at a time: a root is
/// only ever put below a lower vertex, so that the trees that come out in the end have the same roots whoever came
/// first.
class VertexTrees {
 public:
  explicit VertexTrees(Buffer<Index>& parents) : parents_(parents) {}

  Index root_of(Index v) {
    for (Index parent = load(v); parent != v; parent = load(v)) {
      const Index next = load(parent);
      if (next != parent) __atomic_store_n(&parents_[v], next, __ATOMIC_RELAXED);
      v = next;
    }
    return v;
  }
  void join(Index a, Index b) {
    while (true) {
      a = root_of(a);
      b = root_of(b);
      if (a == b) return;
      Index high = std::max(a, b);
      if (__atomic_compare_exchange_n(&parents_[high], &high, std::min(a, b), false, __ATOMIC_RELAXED,
                                      __ATOMIC_RELAXED)) {
        return;
      }
    }
  }

 private:
  Index load(Index v) const { return __atomic_load_n(&parents_[v], __ATOMIC_RELAXED); }

  Buffer<Index>& parents_;
};

}  // namespace

Components connected_components(const Topology& topology) {
  Components components;
  Buffer<Index>& roots = components.of_vertex;
  const Index vertex_count = topology.vertex_count();
  roots.resize(static_cast<std::size_t>(vertex_count));
  parallel_for(vertex_count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::iota(roots.begin() + begin, roots.begin() + end, static_cast<Index>(begin));
  });
  VertexTrees trees(roots);
  parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const Index first = topology.origin(topology.face_begin(f));
      for (Index h = topology.face_begin(f) + 1; h < topology.face_end(f); ++h) trees.join(first, topology.origin(h));
    }
  });
  // Roots are numbered in order; then each vertex takes the number of its root.
  Buffer<Index> numbers(roots.size());
  for (Index v = 0; v < vertex_count; ++v) {
    if (roots[v] == v) numbers[v] = components.count++;
  }
  Buffer<Index> of_vertex(roots.size());
  parallel_for(vertex_count, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) of_vertex[v] = numbers[trees.root_of(v)];
  });
  components.of_vertex = std::move(of_vertex);
  return components;
}

Mesh mesh_from_topology(const Topology& topology) {
  const TopologyTables& tables = topology.tables();
  Mesh mesh;
  mesh.face_offsets = tables.face_offsets;
  mesh.face_vertices = tables.origins;
  for (std::size_t e = 0; e < tables.edge_sharpness.size(); ++e) {
    if (tables.edge_sharpness[e] <= 0.0F) continue;
    const Index h = tables.edge_half_edges[e];
    mesh.creases.push_back({topology.origin(h), topology.destination(h), tables.edge_sharpness[e]});
  }
  for (std::size_t v = 0; v < tables.vertex_sharpness.size(); ++v) {
    if (tables.vertex_sharpness[v] > 0.0F) mesh.corners.push_back({static_cast<Index>(v), tables.vertex_sharpness[v]});
  }
  for (std::size_t f = 0; f < tables.holes.size(); ++f) {
    if (tables.holes[f] != 0) mesh.holes.push_back(static_cast<Index>(f));
  }
  return mesh;
}

}  // namespace batten
