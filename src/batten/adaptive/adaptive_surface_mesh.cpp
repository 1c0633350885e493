#include "batten/adaptive/adaptive_surface_mesh.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "batten/adaptive/butterfly_points.h"
#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/checked_values.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/surface_patches.h"
#include "batten/progress.h"
#include "batten/refine/face_varying.h"
#include "batten/refine/refined_mesh.h"
#include "batten/tessellate/linear_in_face.h"

namespace batten {

namespace {

/// The points of the surface that control points span at places.
using PointsAt = std::function<void(ConstValuesRef control, std::span<const SurfacePlace>, Eigen::Ref<Points>)>;

PointsAt butterfly_points_at(const SurfacePatches& patches) {
  return [&patches](ConstValuesRef control, std::span<const SurfacePlace> places, Eigen::Ref<Points> points) {
    ButterflyPoints(patches.topology(), patches.scheme(), control).evaluate(places, points);
  };
}

PointsAt spline_points_at(const SurfacePatches& patches) {
  // One surface serves all values, which move its control points.
  const auto surface = std::make_shared<std::unique_ptr<LimitSurface>>();
  return [&patches, surface](ConstValuesRef control, std::span<const SurfacePlace> places, Eigen::Ref<Points> points) {
    if (*surface == nullptr) {
      *surface = std::make_unique<LimitSurface>(patches, control);
    } else {
      (*surface)->set_control(control);
    }
    constexpr std::size_t kChunk = 1 << 15;
    std::vector<Jet> jets;
    for (std::size_t begin = 0; begin < places.size(); begin += kChunk) {
      jets.resize(std::min(kChunk, places.size() - begin));
      (*surface)->jets(places.subspan(begin, jets.size()), jets);
      for (std::size_t i = 0; i < jets.size(); ++i) {
        points.row(static_cast<Eigen::Index>(begin + i)) = jets[i].point.transpose();
      }
    }
  };
}

/// Values at the vertices follow the scheme as the points do, three columns at a time.
Values values_at(const PointsAt& points_at, const std::vector<SurfacePlace>& places, const Values& control) {
  Values values(static_cast<Eigen::Index>(places.size()), control.cols());
  Points points(values.rows(), 3);
  for (Eigen::Index first = 0; first < control.cols(); first += 3) {
    const Eigen::Index columns = std::min<Eigen::Index>(3, control.cols() - first);
    Values block = Values::Zero(control.rows(), 3);
    block.leftCols(columns) = control.middleCols(first, columns);
    points_at(block, places, points);
    values.middleCols(first, columns) = points.leftCols(columns);
  }
  return values;
}

/// Where a corner of the result lies in its base face.
struct BoundaryPlace {
  Index corner = -1;  ///< the half-edge that starts here
  Index side = -1;    ///< or the half-edge that it lies inside
};

BoundaryPlace boundary_place(const Topology& base, Index face, const std::array<double, 2>& at) {
  const auto [u, v] = at;
  const Index size = base.face_size(face);
  const bool quad = size == 4;
  const bool on[4] = {v == 0.0, quad ? u == 1.0 : u + v == 1.0, quad ? v == 1.0 : u == 0.0, quad && u == 0.0};
  for (Index s = 0; s < size; ++s) {
    if (!on[s]) continue;
    const Index h = base.face_begin(face) + s;
    if (on[s == 0 ? size - 1 : s - 1]) return {h, -1};
    if (!on[s + 1 == size ? 0 : s + 1]) return {-1, h};
  }
  return {};
}

/// Fills `values`, a row for each corner of the result that is listed.
using CornerValues = std::function<void(const Buffer<std::size_t>& corners, Eigen::Ref<Values> values)>;

/// Values at the corners of the base, and those that values_of gives inside its faces and edges, at the corners of the
/// result.
class CarriedCorners {
 public:
  CarriedCorners(const Topology& base, const Attribute& attribute, const AdaptiveMesh& result)
      : base_(base), attribute_(attribute), result_(result), at_vertex_(result.places.size(), {-1, -1}) {}

  Attribute carry(const CornerValues& values_of) {
    const auto size = static_cast<std::size_t>(result_.mesh.face_size(0));
    Buffer<Index> rows(result_.mesh.face_vertices.size());
    for (std::size_t c = 0; c < rows.size(); ++c) rows[c] = row_of(c, result_.base_faces[c / size]);
    const Eigen::Index given = attribute_.values.rows();
    Values values(given + static_cast<Eigen::Index>(new_rows_.size()), attribute_.values.cols());
    values.topRows(given) = attribute_.values;
    values_of(new_rows_, values.bottomRows(static_cast<Eigen::Index>(new_rows_.size())));
    return {attribute_.name, std::move(values), std::move(rows)};
  }

 private:
  bool has_rows(Index face) const {
    const auto begin = attribute_.corner_rows.begin() + base_.face_begin(face);
    return std::none_of(begin, begin + base_.face_size(face), [](Index row) { return row < 0; });
  }

  /// True if the edge is no seam, and the half-edge is not the first of its edge.
  bool is_twins(Index h) const {
    const Buffer<Index>& rows = attribute_.corner_rows;
    const Index twin = base_.twin(h);
    return twin >= 0 && twin < h && rows[h] == rows[base_.next(twin)] && rows[base_.next(h)] == rows[twin];
  }

  /// The row of a corner of the result: that of the base's corner, or one for each vertex inside a base face, or inside
  /// an edge one a side.
  Index row_of(std::size_t corner, Index face) {
    if (!has_rows(face)) return -1;
    const BoundaryPlace place = boundary_place(base_, face, result_.corner_parameters[corner]);
    if (place.corner >= 0) return attribute_.corner_rows[place.corner];
    const bool upper =
        place.side >= 0 && base_.twin(place.side) >= 0 && base_.twin(place.side) < place.side && !is_twins(place.side);
    Index& row = at_vertex_[result_.mesh.face_vertices[corner]][upper ? 1 : 0];
    if (row < 0) {
      row = static_cast<Index>(attribute_.values.rows() + static_cast<Eigen::Index>(new_rows_.size()));
      new_rows_.push_back(corner);
    }
    return row;
  }

  const Topology& base_;
  const Attribute& attribute_;
  const AdaptiveMesh& result_;
  Buffer<std::array<Index, 2>> at_vertex_;
  Buffer<std::size_t> new_rows_;  ///< the corner of the result where each was found
};

Attribute at_base(const SurfacePatches& patches, const Attribute& attribute) {
  if (attribute.corner_rows.size() != static_cast<std::size_t>(patches.topology().half_edge_count())) {
    throw Error(ErrorCode::BadShape, "attribute '" + attribute.name + "' must have one row number per corner");
  }
  const bool refined = patches.has_first_step();
  return refined ? refine_at_corners(patches.topology(), patches.scheme().kind, attribute) : attribute;
}

/// Linear within the faces of the base.
Attribute carry_linearly(const SurfacePatches& patches, const Attribute& attribute, const AdaptiveMesh& result) {
  const Attribute known = at_base(patches, attribute);
  const Topology& base = patches.base();
  const auto size = static_cast<std::size_t>(result.mesh.face_size(0));
  const auto linear = [&](const Buffer<std::size_t>& corners, Eigen::Ref<Values> values) {
    parallel_for(values.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        const Index face = result.base_faces[corners[i] / size];
        const Index* rows = &known.corner_rows[base.face_begin(face)];
        const auto corner = [&](Index k) { return known.values.row(rows[k]); };
        const std::array<double, 2>& at = result.corner_parameters[corners[i]];
        set_linear(base.face_size(face) == 4, at[0], at[1], corner, values.row(i));
      }
    });
  };
  return CarriedCorners(base, known, result).carry(linear);
}

/// On the surface that the values make themselves.
Attribute carry_smoothly(const SurfacePatches& patches, const Attribute& attribute, const AdaptiveMesh& result) {
  const FaceVaryingSurface surface = face_varying_surface(patches.topology(), patches.scheme(), attribute);
  const SurfacePatches value_patches(surface.topology, surface.scheme);
  const bool refined = value_patches.has_first_step();
  const FaceVaryingSurface base = refined ? surface.refined() : surface;
  Attribute known = base.attribute(attribute.name);
  known.values = LimitMatrix(base.topology, base.scheme).apply(base.values);
  const auto size = static_cast<std::size_t>(result.mesh.face_size(0));
  const PointsAt points_at = spline_points_at(value_patches);
  const auto limit = [&](const Buffer<std::size_t>& corners, Eigen::Ref<Values> values) {
    std::vector<SurfacePlace> places;
    for (const std::size_t corner : corners) {
      const std::array<double, 2>& at = result.corner_parameters[corner];
      places.push_back({result.base_faces[corner / size], at[0], at[1]});
    }
    values = values_at(points_at, places, surface.values);
  };
  return CarriedCorners(patches.base(), known, result).carry(limit);
}

template <typename T>
void permute(const Buffer<Index>& order, std::size_t width, Buffer<T>& numbers) {
  Buffer<T> moved(numbers.size());
  for (std::size_t f = 0; f < order.size(); ++f) {
    const auto from = numbers.begin() + static_cast<std::ptrdiff_t>(width) * order[f];
    std::copy(from, from + static_cast<std::ptrdiff_t>(width), moved.begin() + static_cast<std::ptrdiff_t>(width * f));
  }
  numbers = std::move(moved);
}

/// Sorts the result's faces by the control faces that they lie in, so that groups can begin at one.
void carry_groups(const SurfacePatches& patches, const Mesh& control, AdaptiveMesh& result) {
  if (control.groups.empty() || result.mesh.face_count() == 0) return;
  const Index control_faces = patches.topology().face_count();
  Buffer<Index> starts(static_cast<std::size_t>(control_faces) + 1, 0);
  for (const Index face : result.base_faces) ++starts[patches.control_face(face) + 1];
  for (Index f = 0; f < control_faces; ++f) starts[f + 1] += starts[f];
  for (const Group& group : control.groups) {
    if (group.first_face < 0 || group.first_face > control_faces) {
      throw Error(ErrorCode::IndexOutOfRange, "group '" + group.name + "' begins at face " +
                                                  std::to_string(group.first_face) + " of " +
                                                  std::to_string(control_faces));
    }
    result.mesh.groups.push_back({group.keyword, group.name, starts[group.first_face]});
  }
  Buffer<Index> order(result.base_faces.size());
  Buffer<Index> next = starts;
  for (std::size_t f = 0; f < order.size(); ++f) {
    order[next[patches.control_face(result.base_faces[f])]++] = static_cast<Index>(f);
  }
  const auto size = static_cast<std::size_t>(result.mesh.face_size(0));
  permute(order, size, result.mesh.face_vertices);
  permute(order, 1, result.base_faces);
  permute(order, size, result.corner_parameters);
  for (Attribute& attribute : result.mesh.attributes) {
    if (attribute.per_corner()) permute(order, size, attribute.corner_rows);
  }
}

/// Linear within the faces of the base, from the control vertices.
Values midpoints_at(const SurfacePatches& patches, const std::vector<SurfacePlace>& places, const Values& control) {
  const bool refined = patches.has_first_step();
  const Values known = refined ? refine_midpoints(patches.topology(), patches.scheme().kind, control) : control;
  const Topology& base = patches.base();
  Values values(static_cast<Eigen::Index>(places.size()), control.cols());
  parallel_for(values.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const SurfacePlace& place = places[i];
      const auto corner = [&](Index k) { return known.row(base.origin(base.face_begin(place.face) + k)); };
      set_linear(base.face_size(place.face) == 4, place.u, place.v, corner, values.row(i));
    }
  });
  return values;
}

}  // namespace

AdaptiveMesh adaptive_surface_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control,
                                   const AdaptiveOptions& options, const Progress& progress) {
  constexpr double kTessellated = 0.8;  // of the time
  const SurfacePatches patches(topology, scheme);
  AdaptiveMesh result =
      tessellate_adaptively(patches, control.points, options, progress_within(progress, 0.0, kTessellated));
  result.mesh.material_libraries = control.material_libraries;
  carry_groups(patches, control, result);
  const PointsAt points_at = is_interpolating(scheme.kind) ? butterfly_points_at(patches) : spline_points_at(patches);
  const double share = (1.0 - kTessellated) / static_cast<double>(control.attributes.size() + 1);
  double done = kTessellated;
  for (const Attribute& attribute : control.attributes) {
    report_progress(progress, done += share);
    if (attribute.name == "normal") continue;  // those of the surface are there
    if (!attribute.per_corner()) {
      require_finite(attribute.values, ("attribute '" + attribute.name + "'").c_str());
      const bool linear = attribute.carry == CarryRule::Midpoint;
      result.mesh.attributes.push_back({attribute.name,
                                        linear ? midpoints_at(patches, result.places, attribute.values)
                                               : values_at(points_at, result.places, attribute.values),
                                        {}});
    } else if (result.mesh.face_count() > 0) {
      const bool linear = scheme.has_linear_corners();
      result.mesh.attributes.push_back(linear ? carry_linearly(patches, attribute, result)
                                              : carry_smoothly(patches, attribute, result));
    }
  }
  report_progress(progress, 1.0);
  return result;
}

}  // namespace batten
