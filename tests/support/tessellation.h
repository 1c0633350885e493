/// \file Compares a tessellation point by point with Refinement, whose vertices have another order.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "batten/limit/limit_matrix.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/tessellator.h"

namespace batten::test {

/// Refinement's vertex at the point (i, j) of a face's grid, by descending through the levels.
inline Index refined_vertex(const std::vector<Topology>& levels, bool quads, Index face, Index i, Index j) {
  Index n = Index{1} << (levels.size() - 1);
  for (std::size_t level = 0; level + 1 < levels.size(); ++level, n /= 2) {
    const Index half = n / 2;
    const Index first = levels[level].face_begin(face);
    const Index a = i;
    const Index b = j;
    if (quads) {
      const int corner = a >= half ? (b >= half ? 2 : 1) : (b >= half ? 3 : 0);
      face = first + corner;
      if (corner == 1) i = b, j = n - a;
      if (corner == 2) i = n - a, j = n - b;
      if (corner == 3) i = n - b, j = a;
    } else if (n - a - b >= half) {
      face = 4 * face;
    } else if (a >= half) {
      face = 4 * face + 1, i = b, j = n - a - b;
    } else if (b >= half) {
      face = 4 * face + 2, i = n - a - b, j = a;
    } else {
      face = 4 * face + 3, i = a + b - half, j = half - a;
    }
  }
  const Index first = levels.back().face_begin(face);
  if (quads) return levels.back().origin(first + (i == 1 ? (j == 1 ? 2 : 1) : (j == 1 ? 3 : 0)));
  return levels.back().origin(first + (i == 1 ? 1 : j == 1 ? 2 : 0));
}

/// The largest distances between what both give, relative to the size; of normals, their difference.
struct TessellationErrors {
  double refined = 0.0;
  double limit = 0.0;
  double normal = 0.0;
};

template <typename Scalar>
TessellationErrors compare_with_refinement(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                                           int levels) {
  const Tessellator tessellator(topology, scheme, levels);
  std::vector<Topology> bases{tessellator.base()};
  const bool same_base =
      bases[0].vertex_count() == topology.vertex_count() && bases[0].half_edge_count() == topology.half_edge_count();
  Values values = same_base ? Values(control) : refine(topology, scheme, control, 1).values;
  const Scheme later = scheme.after_first_step();
  for (Index n = 1; n < tessellator.steps(); n *= 2) {
    Refinement step(bases.back(), later);
    values = step.apply(values);
    bases.push_back(step.child());
  }
  const Topology& finest = bases.back();
  const Values limits = LimitMatrix(finest, later).apply(values);
  const LimitNormals normals = limit_normals(finest, later, values);
  const auto count = static_cast<std::size_t>(tessellator.vertex_count());
  Buffer<Scalar> refined(3 * count, std::numeric_limits<Scalar>::quiet_NaN());
  Buffer<Scalar> limit = refined;
  Buffer<Scalar> unit = refined;
  tessellator.refined<Scalar>(control, refined);
  tessellator.limit<Scalar>(control, limit, unit);

  TessellationErrors errors;
  // Floats round in proportion to the coordinates.
  const double diagonal =
      std::max(bounding_diagonal(control), control.size() > 0 ? control.cwiseAbs().maxCoeff() : 1.0);
  const auto row = [](const Buffer<Scalar>& rows, Index v) {
    return Eigen::RowVector3d(rows[3 * v], rows[3 * v + 1], rows[3 * v + 2]);
  };
  const auto grow = [](double& error, double now) { error = now > error || now != now ? now : error; };
  std::vector<Index> partner(count, -1);
  const Topology& base = tessellator.base();
  const bool quads = tessellator.face_size() == 4;
  for (Index f = 0; f < base.face_count(); ++f) {
    for (Index j = 0; j <= tessellator.steps(); ++j) {
      for (Index i = 0; i <= tessellator.steps() - (quads ? 0 : j); ++i) {
        const Index ours = tessellator.vertex(f, i, j);
        const Index theirs = refined_vertex(bases, quads, f, i, j);
        EXPECT_TRUE(partner[ours] < 0 || partner[ours] == theirs) << "vertex " << ours << " is two points";
        partner[ours] = theirs;
        grow(errors.refined, (row(refined, ours) - values.row(theirs)).norm() / diagonal);
        grow(errors.limit, (row(limit, ours) - limits.row(theirs)).norm() / diagonal);
        // At a crease there are several normals: one of them.
        double nearest = std::numeric_limits<double>::infinity();
        finest.for_each_outgoing(
            theirs, [&](Index h) { nearest = std::min(nearest, (row(unit, ours) - normals.corners.row(h)).norm()); });
        grow(errors.normal, nearest);
      }
    }
  }
  std::vector<std::uint8_t> met(static_cast<std::size_t>(finest.vertex_count()), 0);
  for (std::size_t v = 0; v < count; ++v) {
    if (partner[v] < 0) {
      EXPECT_TRUE(static_cast<Index>(v) < topology.vertex_count() && topology.is_isolated(static_cast<Index>(v)));
      EXPECT_EQ(row(limit, static_cast<Index>(v)), row(refined, static_cast<Index>(v)));
    } else {
      EXPECT_EQ(met[partner[v]]++, 0) << "two vertices stand for one";
    }
  }

  // Faces: the same set, each from its own first corner on.
  using Face = std::array<Index, 4>;
  const auto add_face = [size = tessellator.face_size()](std::vector<Face>& all, Face face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.begin() + size), face.begin() + size);
    all.push_back(face);
  };
  std::vector<Face> expected;
  const Topology with_holes = with_surface_holes(topology, scheme);
  const RefinedSurface hidden = refine(with_holes, scheme, control, levels);
  for (Index f = 0; f < finest.face_count(); ++f) {
    if (hidden.topology.is_hole(f)) continue;
    Face face{};
    for (Index h = finest.face_begin(f); h < finest.face_end(f); ++h) face[h - finest.face_begin(f)] = finest.origin(h);
    add_face(expected, face);
  }
  Buffer<Index> faces(static_cast<std::size_t>(tessellator.face_count()) *
                      static_cast<std::size_t>(tessellator.face_size()));
  tessellator.faces(faces);
  std::vector<Face> found;
  for (std::size_t c = 0; c < faces.size(); c += static_cast<std::size_t>(tessellator.face_size())) {
    Face face{};
    for (Index s = 0; s < tessellator.face_size(); ++s) face[s] = partner[faces[c + static_cast<std::size_t>(s)]];
    add_face(found, face);
  }
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  EXPECT_TRUE(found == expected) << "the faces differ";
  return errors;
}

}  // namespace batten::test
