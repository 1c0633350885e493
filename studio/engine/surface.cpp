#include "studio/engine/surface.h"

#include <algorithm>
#include <utility>

#include "batten/interpolate/fair_mesh.h"
#include "batten/interpolate/local_normals.h"
#include "batten/medial/medial_surface.h"
#include "batten/mesh/vertex_fields.h"
#include "batten/tessellate/surface_mesh.h"

namespace batten::studio {
namespace {

/// Steps of the mesh that is drawn, where `asked` is 0 as suits the screen.
int drawn_levels(const Topology& topology, int asked) {
  constexpr double kOnScreen = 120'000.0;  // and software draws them in time
  constexpr int kMostOnScreen = 4;
  constexpr double kInMemory = 4e6;
  const int levels =
      asked > 0 ? levels_within(topology, kInMemory, asked) : levels_within(topology, kOnScreen, kMostOnScreen);
  return std::max(1, levels);
}

std::vector<std::uint32_t> triangles_of(const Tessellator& tessellator) {
  const Index size = tessellator.face_size();
  Buffer<Index> faces(static_cast<std::size_t>(tessellator.face_count()) * static_cast<std::size_t>(size));
  tessellator.faces(faces);
  std::vector<std::uint32_t> triangles;
  triangles.reserve(faces.size() / static_cast<std::size_t>(size) * static_cast<std::size_t>(3 * (size - 2)));
  for (std::size_t i = 0; i < faces.size(); i += static_cast<std::size_t>(size))
    for (std::size_t k = 2; k < static_cast<std::size_t>(size); ++k)
      for (const Index vertex : {faces[i], faces[i + k - 1], faces[i + k]})
        triangles.push_back(static_cast<std::uint32_t>(vertex));
  return triangles;
}

/// Of rows of three numbers, those of some vertices.
std::vector<float> rows_of(const std::vector<float>& numbers, const std::vector<Index>& vertices) {
  std::vector<float> rows;
  rows.reserve(3 * vertices.size());
  for (const Index vertex : vertices) {
    const auto begin = numbers.begin() + 3 * static_cast<std::ptrdiff_t>(vertex);
    rows.insert(rows.end(), begin, begin + 3);
  }
  return rows;
}

}  // namespace

Surface::Surface(std::shared_ptr<const MeshFile> file, const SurfaceWishes& wishes, const Progress& progress)
    : file_(std::move(file)),
      wishes_(wishes),
      given_(file_->mesh(), progress),
      targets_(file_->mesh().points),
      topology_(given_),
      scheme_(wishes.scheme),
      control_(targets_) {
  if (given_.face_count() == 0)
    throw Error(ErrorCode::BadArgument, "there are no faces: fit a surface to these points");
  solve(progress);
}

void Surface::solve(const Progress& progress) {
  moved_.reset();
  worst_angle_.reset();
  if (!wishes_.interpolated || is_interpolating(scheme_.kind)) {
    control_ = targets_;
    return;
  }
  if (wishes_.fair) {
    solve_fairly(progress);
    return;
  }
  if (!interpolator_) {
    const InterpolateOptions options = file_->is_medial() ? medial_interpolation() : InterpolateOptions();
    interpolator_.emplace(given_, wishes_.scheme, options, progress);
  }
  Interpolant result = interpolator_->solve(targets_, progress);
  topology_ = result.topology;
  scheme_ = result.scheme;
  control_ = std::move(result.control);
  solved_ = std::move(result.report);
  if (!has_normals()) return;
  TurnedSurface turned = turn_normals(topology_, scheme_, control_, wishes_.normals, {}, progress);
  topology_ = turned.topology;
  scheme_ = turned.scheme;
  control_ = std::move(turned.control);
  worst_angle_ = turned.report.after_angle.max;
}

FairOptions Surface::fair_options() const {
  FairOptions options;
  options.smoothing = wishes_.smoothing;
  options.normals = wishes_.normals;
  return options;
}

void Surface::solve_fairly(const Progress& progress) {
  FairInterpolant result = interpolate_fairly(given_, wishes_.scheme, targets_, fair_options(), progress);
  topology_ = result.topology;
  scheme_ = result.scheme;
  control_ = std::move(result.control);
  solved_.emplace();
  solved_->solve = result.report.solve;
  solved_->diagonal = result.report.diagonal;
  solved_->max_error = result.report.max_error;
  solved_->rms_error = result.report.rms_error;
  solved_->worst.push_back({result.report.worst_vertex, result.report.max_error});
  if (has_normals()) worst_angle_ = result.report.max_angle;
}

void Surface::prepare() {
  if (patches_ && patches_->topology().vertex_count() == control_.rows()) return;
  patches_.emplace(topology_, scheme_);
  limit_.reset();
  nearest_.reset();
  moved_.reset();
  if (is_adaptive()) return;
  levels_ = drawn_levels(topology_, wishes_.levels);
  tessellator_.emplace(*patches_, levels_);
  points_.resize(3 * static_cast<std::size_t>(tessellator_->vertex_count()));
  normals_.resize(points_.size());
}

val Surface::report() const {
  val result = val::object();
  result.set("vertices", topology_.vertex_count());
  result.set("faces", topology_.face_count());
  result.set("points", given_.vertex_count());
  result.set("isRefined", topology_.vertex_count() != given_.vertex_count());
  result.set("diagonal", bounding_diagonal(targets_));
  result.set("scheme", std::string(scheme_name(scheme_.kind)));
  result.set("levels", levels_);
  if (adaptive_) {
    result.set("triangles", static_cast<double>(adaptive_->triangles.size() / 3));
    result.set("unmet", adaptive_->adaptive.unmet);
  }
  if (!solved_) return result;
  result.set("maxError", solved_->max_error);
  result.set("rmsError", solved_->rms_error);
  result.set("maxMovement", (control_.topRows(targets_.rows()) - targets_).rowwise().norm().maxCoeff());
  result.set("method", std::string(solved_->solve.method_name));
  result.set("iterations", solved_->solve.iterations);
  result.set("seconds", solved_->solve.seconds);
  result.set("residuals", typed_array(solved_->solve.residual_history));
  result.set("measuredAfter", typed_array(solved_->solve.measured_after));
  if (worst_angle_) result.set("worstAngle", *worst_angle_);
  result.set("singular", static_cast<double>(solved_->singular.size()));
  return result;
}

val Surface::drawing() {
  return guarded([&] {
    prepare();
    val result = shape(val::null());
    if (tessellator_) result.set("triangles", typed_array(triangles_of(*tessellator_)));
    std::vector<std::uint32_t> edges;
    std::vector<float> sharpness;
    for (Index edge = 0; edge < topology_.edge_count(); ++edge) {
      const Index half_edge = topology_.edge_half_edge(edge);
      edges.push_back(static_cast<std::uint32_t>(topology_.origin(half_edge)));
      edges.push_back(static_cast<std::uint32_t>(topology_.destination(half_edge)));
      sharpness.push_back(static_cast<float>(crease_sharpness(topology_, edge)));
    }
    result.set("edges", typed_array(edges));
    result.set("sharpness", typed_array(sharpness));
    return result;
  });
}

val Surface::shape(const val& room) {
  return guarded([&] {
    prepare();
    const bool is_fresh = room.isNull() || room.isUndefined();
    const auto in_room = [&](const char* name, const std::vector<float>& numbers) {
      return is_fresh ? typed_array(numbers) : typed_array_in(room[name], numbers);
    };
    val result = val::object();
    result.set("control", in_room("control", to_floats(control_)));
    if (is_adaptive()) {
      adaptive_ = draw_adaptively(*patches_, control_, wishes_.chord);
      result.set("points", typed_array(adaptive_->points));
      result.set("normals", typed_array(adaptive_->normals));
      result.set("triangles", typed_array(adaptive_->triangles));
      return result;
    }
    tessellator_->limit<float>(control_, points_, normals_);
    moved_.emplace();
    result.set("points", in_room("points", points_));
    result.set("normals", in_room("normals", normals_));
    return result;
  });
}

val Surface::change(const val& room) {
  return guarded([&] {
    prepare();
    if (!moved_ || is_adaptive()) return shape(room);
    std::vector<Index> moved = std::exchange(*moved_, {});
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    const std::vector<Index> vertices = tessellator_->limit_around<float>(moved, control_, points_, normals_);
    val result = val::object();
    result.set("vertices", typed_array(vertices));
    result.set("points", typed_array(rows_of(points_, vertices)));
    result.set("normals", typed_array(rows_of(normals_, vertices)));
    result.set("moved", typed_array(moved));
    result.set("control", typed_array(to_floats(control_(moved, Eigen::all))));
    return result;
  });
}

void Surface::take(const InterpolationUpdates& updates) {
  topology_ = updates.topology();
  scheme_ = updates.scheme();
  if (control_.rows() != updates.control().rows() ||
      updates.moved().size() > static_cast<std::size_t>(control_.rows()) / 8) {
    control_ = updates.control();
    moved_.reset();
    return;
  }
  if (moved_) moved_->insert(moved_->end(), updates.moved().begin(), updates.moved().end());
  for (const Index vertex : updates.moved()) control_.row(vertex) = updates.control().row(vertex);
}

val Surface::move(int vertex, double x, double y, double z, int rings) {
  return guarded([&] {
    if (vertex < 0 || vertex >= targets_.rows()) throw Error(ErrorCode::IndexOutOfRange, "there is no such point");
    const Eigen::RowVector3d target(x, y, z);
    val result = val::object();
    is_current_ = false;
    if (!interpolator_ || has_normals()) {
      targets_.row(vertex) = target;
      solve({});
      return result;
    }
    if (!updates_) {
      updates_.emplace(*interpolator_, targets_);
      control_ = updates_->control();
      moved_.reset();
    }
    const Index rows[] = {static_cast<Index>(vertex)};
    const UpdateReport report =
        rings > 0 ? updates_->update_within(rings, rows, target) : updates_->update(rows, target);
    take(*updates_);
    if (rings > 0) {
      targets_ = updates_->targets();
    } else {
      targets_.row(vertex) = target;
    }
    solved_->max_error = report.error_bound;
    result.set("moved", report.moved);
    result.set("local", report.is_local);
    result.set("maxError", report.error_bound);
    result.set("missed", report.missed);
    return result;
  });
}

val Surface::follow(const Elastic& body) {
  return guarded([&] {
    Points control = body.control_points();
    if (control.rows() != control_.rows()) throw Error(ErrorCode::BadShape, "the body is of another connectivity");
    control_ = std::move(control);
    is_current_ = false;
    moved_.reset();
    return val::null();
  });
}

val Surface::limit_points() const {
  return guarded([&] {
    const Points limits = LimitMatrix(topology_, scheme_).apply(control_).topRows(given_.vertex_count());
    return typed_array(limits);
  });
}

Mesh Surface::control_mesh() const {
  Mesh mesh = file_->mesh();
  mesh.points = targets_;
  if (interpolator_) {
    InterpolatedMesh surface = interpolate(*interpolator_, std::move(mesh));
    if (has_normals()) turn_normals(surface, wishes_.normals);
    return std::move(surface.mesh);
  }
  if (wishes_.fair && wishes_.interpolated && !is_interpolating(wishes_.scheme.kind)) {
    return interpolate_fairly(given_, wishes_.scheme, std::move(mesh), AttributeRule::Interpolated, fair_options())
        .mesh;
  }
  state_scheme(wishes_.scheme, mesh);
  return mesh;
}

val Surface::control_file() const {
  return guarded([&] { return val(std::make_shared<MeshFile>(control_mesh(), file_->up())); });
}

val make_surface(const std::shared_ptr<MeshFile>& file, const val& wishes, const val& report) {
  return guarded([&] {
    SurfaceWishes asked;
    asked.scheme.kind = static_cast<SchemeKind>(wishes["scheme"].as<int>());
    asked.scheme.boundary = static_cast<BoundaryRule>(wishes["boundary"].as<int>());
    asked.scheme.alpha = wishes["alpha"].as<double>();
    asked.interpolated = wishes["interpolate"].as<bool>();
    asked.fair = wishes["fair"].as<bool>();
    asked.smoothing = wishes["smoothing"].as<double>();
    asked.levels = wishes["levels"].as<int>();
    asked.chord = wishes["chord"].as<double>();
    asked.normals = wanted_normals_of(wishes["normals"], file->mesh().vertex_count());
    return val(std::make_shared<Surface>(file, asked, progress_of(report)));
  });
}

}  // namespace batten::studio
