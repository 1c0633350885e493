/// \file OpenSubdiv 3.5 as an oracle: its refinement and its limits, brought into the order of our vertices.
///
/// OpenSubdiv numbers child vertices face-, edge- and vertex-wise by its own edges. Rows are matched by structure,
/// never by position: the child of a vertex, of a face, and of the edge between two vertices, level by level from the
/// same input.
#pragma once
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <stdexcept>

#include "batten/refine/refinement.h"

namespace batten::test {

/// The three numbers of a vertex, as PrimvarRefinerReal<double> wants them.
struct OraclePoint {
  std::array<double, 3> x{};
  void Clear() { x.fill(0.0); }
  void AddWithWeight(const OraclePoint& other, double weight) {
    for (int c = 0; c < 3; ++c) x[c] += weight * other.x[c];
  }
};
using OraclePoints = std::vector<OraclePoint>;

/// Limit position and two tangents; the normal is first x second.
struct OracleLimit {
  Points positions;
  Points first_tangents;
  Points second_tangents;
};

inline OpenSubdiv::Sdc::Options oracle_options(const Scheme& scheme) {
  using Options = OpenSubdiv::Sdc::Options;
  Options options;
  const std::array<Options::VtxBoundaryInterpolation, 3> boundaries{
      Options::VTX_BOUNDARY_NONE, Options::VTX_BOUNDARY_EDGE_AND_CORNER, Options::VTX_BOUNDARY_EDGE_ONLY};
  options.SetVtxBoundaryInterpolation(boundaries[static_cast<std::size_t>(scheme.boundary)]);
  options.SetCreasingMethod(scheme.crease_method == CreaseMethod::Chaikin ? Options::CREASE_CHAIKIN
                                                                          : Options::CREASE_UNIFORM);
  options.SetTriangleSubdivision(scheme.triangle_rule == TriangleRule::Smooth ? Options::TRI_SUB_SMOOTH
                                                                              : Options::TRI_SUB_CATMARK);
  const std::array<Options::FVarLinearInterpolation, 6> rules{
      Options::FVAR_LINEAR_NONE,          Options::FVAR_LINEAR_CORNERS_ONLY, Options::FVAR_LINEAR_CORNERS_PLUS1,
      Options::FVAR_LINEAR_CORNERS_PLUS2, Options::FVAR_LINEAR_BOUNDARIES,   Options::FVAR_LINEAR_ALL};
  options.SetFVarLinearInterpolation(rules[static_cast<std::size_t>(scheme.face_varying)]);
  return options;
}

/// The mesh's faces, creases, corners and holes, as OpenSubdiv takes them, and an attribute at corners if one is given.
inline std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> oracle_refiner(const Mesh& mesh, const Scheme& scheme,
                                                                        const Attribute* at_corners = nullptr) {
  using namespace OpenSubdiv;
  std::vector<int> sizes;
  for (Index f = 0; f < mesh.face_count(); ++f) sizes.push_back(mesh.face_size(f));
  std::vector<int> crease_vertices;
  std::vector<float> crease_weights;
  for (const Crease& crease : mesh.creases) {
    crease_vertices.insert(crease_vertices.end(), {crease.a, crease.b});
    crease_weights.push_back(static_cast<float>(crease.sharpness));
  }
  std::vector<int> corner_vertices;
  std::vector<float> corner_weights;
  for (const Corner& corner : mesh.corners) {
    corner_vertices.push_back(corner.vertex);
    corner_weights.push_back(static_cast<float>(corner.sharpness));
  }
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = mesh.vertex_count();
  descriptor.numFaces = mesh.face_count();
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = mesh.face_vertices.data();
  descriptor.numCreases = static_cast<int>(crease_weights.size());
  descriptor.creaseVertexIndexPairs = crease_vertices.data();
  descriptor.creaseWeights = crease_weights.data();
  descriptor.numCorners = static_cast<int>(corner_weights.size());
  descriptor.cornerVertexIndices = corner_vertices.data();
  descriptor.cornerWeights = corner_weights.data();
  descriptor.numHoles = static_cast<int>(mesh.holes.size());
  descriptor.holeIndices = mesh.holes.data();
  Far::TopologyDescriptor::FVarChannel channel;
  if (at_corners != nullptr) {
    channel.numValues = static_cast<int>(at_corners->values.rows());
    channel.valueIndices = at_corners->corner_rows.data();
    descriptor.numFVarChannels = 1;
    descriptor.fvarChannels = &channel;
  }
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  const Sdc::SchemeType kind = scheme.kind == SchemeKind::Loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
  const Factory::Options options(kind, oracle_options(scheme));
  return std::unique_ptr<Far::TopologyRefiner>(Factory::Create(descriptor, options));
}

/// A mesh refined by OpenSubdiv, with every level seen through our numbering.
class Oracle {
 public:
  using Refiner = OpenSubdiv::Far::TopologyRefiner;
  using PrimvarRefiner = OpenSubdiv::Far::PrimvarRefinerReal<double>;

  /// Throws std::runtime_error where OpenSubdiv refuses the mesh or its child faces are not ours.
  /// at_corners: an attribute of at most three columns whose corners all have a row, or none.
  Oracle(const Mesh& mesh, const Scheme& scheme, int levels, const Attribute* at_corners = nullptr)
      : refiner_(oracle_refiner(mesh, scheme, at_corners)) {
    if (refiner_ == nullptr) throw std::runtime_error("OpenSubdiv refuses the mesh");
    Refiner::UniformOptions options(levels);
    options.fullTopologyInLastLevel = true;
    refiner_->RefineUniform(options);
    points_.emplace_back(static_cast<std::size_t>(mesh.vertex_count()));
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      for (int c = 0; c < 3; ++c) points_[0][v].x[c] = mesh.points(v, c);
    }
    if (at_corners != nullptr) add_corner_values(at_corners->values);
    topologies_.emplace_back(mesh);
    vertices_.push_back(identity(mesh.vertex_count()));
    faces_.push_back(identity(mesh.face_count()));
    const PrimvarRefiner primvars(*refiner_);
    for (int level = 1; level <= levels; ++level) {
      points_.emplace_back(static_cast<std::size_t>(refiner_->GetLevel(level).GetNumVertices()));
      OraclePoint* target = points_[level].data();
      primvars.Interpolate(level, points_[level - 1], target);
      if (at_corners != nullptr) {
        corner_points_.emplace_back(static_cast<std::size_t>(refiner_->GetLevel(level).GetNumFVarValues(0)));
        OraclePoint* corner_target = corner_points_[level].data();
        primvars.InterpolateFaceVarying(level, corner_points_[level - 1], corner_target);
      }
      topologies_.push_back(Refinement(topologies_[level - 1], scheme).child());
      match(level, scheme);
    }
  }

  int max_level() const { return static_cast<int>(points_.size()) - 1; }
  /// Our topology of a level; its rows are those of every answer.
  const Topology& topology(int level) const { return topologies_[level]; }

  Values positions(int level) const { return in_our_order(points_[level], level); }

  /// OpenSubdiv's limit masks on its last level.
  OracleLimit limits() const {
    const int level = max_level();
    const OraclePoints& points = points_[level];
    OraclePoints positions(points.size());
    OraclePoints first(points.size());
    OraclePoints second(points.size());
    OraclePoint* rows = positions.data();
    OraclePoint* first_rows = first.data();
    OraclePoint* second_rows = second.data();
    PrimvarRefiner(*refiner_).Limit(points, rows, first_rows, second_rows);
    return {in_our_order(positions, level), in_our_order(first, level), in_our_order(second, level)};
  }

  /// The values at the corners of a level, H-by-3 in the order of our half-edges; columns that were not given are 0.
  Values corner_values(int level) const { return at_half_edges(corner_points_[level], level); }

  /// The limits of the values at the corners of the last level.
  Values corner_limits() const {
    OraclePoints limits(corner_points_[max_level()].size());
    OraclePoint* rows = limits.data();
    PrimvarRefiner(*refiner_).LimitFaceVarying(corner_points_[max_level()], rows);
    return at_half_edges(limits, max_level());
  }

  float edge_sharpness(int level, Index edge) const {
    const Topology& topology = topologies_[level];
    const Index h = topology.edge_half_edge(edge);
    return level_of(level).GetEdgeSharpness(find_edge(level, topology.origin(h), topology.destination(h)));
  }
  float vertex_sharpness(int level, Index vertex) const {
    return level_of(level).GetVertexSharpness(vertices_[level][vertex]);
  }
  bool is_hole(int level, Index face) const { return level_of(level).IsFaceHole(faces_[level][face]); }

 private:
  static Buffer<Index> identity(Index count) {
    Buffer<Index> map(static_cast<std::size_t>(count));
    for (Index i = 0; i < count; ++i) map[i] = i;
    return map;
  }
  OpenSubdiv::Far::TopologyLevel const& level_of(int level) const { return refiner_->GetLevel(level); }

  void add_corner_values(const Values& values) {
    corner_points_.emplace_back(static_cast<std::size_t>(values.rows()));
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      for (Eigen::Index c = 0; c < values.cols(); ++c) corner_points_[0][i].x[c] = values(i, c);
    }
  }

  Values at_half_edges(const OraclePoints& points, int level) const {
    const Topology& topology = topologies_[level];
    Values rows(topology.half_edge_count(), 3);
    for (Index f = 0; f < topology.face_count(); ++f) {
      const Index theirs = faces_[level][f];
      const auto around = level_of(level).GetFaceVertices(theirs);
      const auto corners = level_of(level).GetFaceFVarValues(theirs, 0);
      const Index first = topology.face_begin(f);
      int shift = 0;
      while (around[shift] != vertices_[level][topology.origin(first)]) ++shift;
      for (int i = 0; i < around.size(); ++i) {
        const OraclePoint& point = points[corners[(shift + i) % around.size()]];
        for (int c = 0; c < 3; ++c) rows(first + i, c) = point.x[c];
      }
    }
    return rows;
  }

  Index find_edge(int level, Index a, Index b) const {
    return level_of(level).FindEdge(vertices_[level][a], vertices_[level][b]);
  }

  Values in_our_order(const OraclePoints& points, int level) const {
    Values rows(topologies_[level].vertex_count(), 3);
    for (Index v = 0; v < rows.rows(); ++v) {
      for (int c = 0; c < 3; ++c) rows(v, c) = points[vertices_[level][v]].x[c];
    }
    return rows;
  }

  /// Maps the vertices and faces of a level, from those of the level before.
  void match(int level, const Scheme& scheme) {
    const Topology& parent = topologies_[level - 1];
    const auto& theirs = level_of(level - 1);
    Buffer<Index> vertices;
    for (Index v = 0; v < parent.vertex_count(); ++v) {
      vertices.push_back(theirs.GetVertexChildVertex(vertices_[level - 1][v]));
    }
    for (Index e = 0; e < parent.edge_count(); ++e) {
      const Index h = parent.edge_half_edge(e);
      vertices.push_back(theirs.GetEdgeChildVertex(find_edge(level - 1, parent.origin(h), parent.destination(h))));
    }
    if (scheme.kind == SchemeKind::CatmullClark) {
      for (const Index f : faces_[level - 1]) vertices.push_back(theirs.GetFaceChildVertex(f));
    }
    Buffer<Index> sorted = vertices;
    std::sort(sorted.begin(), sorted.end());
    if (sorted != identity(level_of(level).GetNumVertices())) throw std::runtime_error("vertices do not match");
    vertices_.push_back(std::move(vertices));
    match_faces(level, scheme);
  }

  /// Our child faces in order, four to a triangle (Loop) or one to a corner (Catmull-Clark), are sought among theirs.
  void match_faces(int level, const Scheme& scheme) {
    const Topology& parent = topologies_[level - 1];
    Buffer<Index> faces;
    for (Index f = 0; f < parent.face_count(); ++f) {
      const auto children = level_of(level - 1).GetFaceChildFaces(faces_[level - 1][f]);
      const Index count = scheme.kind == SchemeKind::Loop ? 4 : parent.face_size(f);
      for (Index i = 0; i < count; ++i) {
        const auto ours = static_cast<Index>(faces.size());
        const auto* const found =
            std::find_if(children.begin(), children.end(), [&](Index child) { return same_face(level, ours, child); });
        if (found == children.end()) throw std::runtime_error("faces do not match");
        faces.push_back(*found);
      }
    }
    faces_.push_back(std::move(faces));
  }

  /// The same vertices in the same cyclic order.
  bool same_face(int level, Index ours, Index theirs) const {
    const Topology& topology = topologies_[level];
    const auto around = level_of(level).GetFaceVertices(theirs);
    if (topology.face_size(ours) != around.size()) return false;
    const auto corner = [&](Index i) { return vertices_[level][topology.origin(topology.face_begin(ours) + i)]; };
    int shift = 0;
    while (shift < around.size() && around[shift] != corner(0)) ++shift;
    for (int i = 0; i < around.size(); ++i) {
      if (around[(shift + i) % around.size()] != corner(i)) return false;
    }
    return true;
  }

  std::unique_ptr<Refiner> refiner_;
  std::vector<OraclePoints> points_;  ///< theirs, level by level
  std::vector<OraclePoints> corner_points_;
  std::deque<Topology> topologies_;      ///< ours
  std::vector<Buffer<Index>> vertices_;  ///< our vertex -> theirs
  std::vector<Buffer<Index>> faces_;     ///< our face -> theirs
};

}  // namespace batten::test
