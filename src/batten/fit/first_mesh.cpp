#include "batten/fit/first_mesh.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/fit/cloud_field.h"
#include "batten/fit/contour_parts.h"
#include "batten/fit/contour_search.h"
#include "batten/fit/far_groups.h"
#include "batten/mesh/unit_scale.h"

namespace batten {

Index FirstMesh::genus() const {
  Index sum = 0;
  for (const FirstMeshPart& part : parts) sum += part.genus;
  return sum;
}

namespace {

constexpr Index kFewestPoints = 20;

/// Part of a cloud.
PointCloud taken_rows(const PointCloud& cloud, const Buffer<Index>& rows) {
  PointCloud part;
  const auto count = static_cast<Eigen::Index>(rows.size());
  part.points.resize(count, 3);
  part.normals.resize(cloud.normals.rows() > 0 ? count : 0, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    part.points.row(i) = cloud.points.row(rows[i]);
    if (part.normals.rows() > 0) part.normals.row(i) = cloud.normals.row(rows[i]);
  }
  return part;
}

/// The fields of the groups of a cloud, which each have a grid of their own.
std::vector<CloudField> cloud_fields(const PointCloud& cloud, Index vertices, const Progress& progress) {
  const std::vector<Buffer<Index>> groups = far_groups(cloud.points * unit_scale(cloud.points), kFewestPoints);
  std::vector<CloudField> fields;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const double count = static_cast<double>(groups.size());
    const Progress part = progress_within(progress, g / count, (g + 1) / count);
    const bool whole = static_cast<Eigen::Index>(groups[g].size()) == cloud.points.rows();
    CloudSamples samples =
        prepare_cloud(whole ? cloud : taken_rows(cloud, groups[g]), vertices, progress_within(part, 0.0, 0.7));
    fields.emplace_back(std::move(samples), vertices, progress_within(part, 0.7, 1.0));
  }
  return fields;
}

double area_of(const CloudField& field) { return field.samples.areas.sum() * field.samples.size * field.samples.size; }

/// Adds a contour in the unit of the cloud.
void append_contour(FirstMesh& result, const FoundContour& found, const CloudField& field) {
  Mesh& mesh = result.mesh;
  const Index first = mesh.vertex_count();
  mesh.points.conservativeResize(first + found.mesh.vertex_count(), 3);
  mesh.points.bottomRows(found.mesh.vertex_count()) =
      (found.mesh.points * field.samples.size).rowwise() + field.samples.centre;
  for (Index f = 0; f < found.mesh.face_count(); ++f) {
    for (Index c = found.mesh.face_offsets[f]; c < found.mesh.face_offsets[f + 1]; ++c)
      mesh.face_vertices.push_back(first + found.mesh.face_vertices[c]);
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  for (const Crease& crease : found.mesh.creases)
    mesh.creases.push_back({first + crease.a, first + crease.b, crease.sharpness});
  const std::vector<FirstMeshPart> parts = mesh_parts(found.mesh);
  result.parts.insert(result.parts.end(), parts.begin(), parts.end());
  result.repeated_points += field.samples.repeated;
  result.outliers += field.samples.outliers;
  result.dropped_parts += found.dropped;
}

void require_options(const FirstMeshOptions& options) {
  if (options.vertices < 8 || options.vertices > 1000000)
    throw Error(ErrorCode::BadArgument, "a first mesh has 8 to 1,000,000 vertices");
  if (options.genus && *options.genus < 0) throw Error(ErrorCode::BadArgument, "a genus is 0 or more");
  if (options.bridge && !(*options.bridge >= 0.0 && std::isfinite(*options.bridge)))
    throw Error(ErrorCode::BadArgument, "the width of a bridge is 0 or more");
}

}  // namespace

FirstMesh first_mesh(const PointCloud& cloud, const FirstMeshOptions& options, const Progress& progress) {
  require_options(options);
  require_cloud(cloud);
  const std::vector<CloudField> fields = cloud_fields(cloud, options.vertices, progress_within(progress, 0.0, 0.7));
  std::size_t largest = 0;
  double area = 0.0;
  Index in_groups = 0;
  for (std::size_t g = 0; g < fields.size(); ++g) {
    area += area_of(fields[g]);
    in_groups += fields[g].samples.given;
    if (area_of(fields[g]) > area_of(fields[largest])) largest = g;
  }
  // The genus asked for is that of all: the largest group takes what the others leave.
  std::vector<FoundContour> found(fields.size());
  FirstMeshOptions own = options;
  for (std::size_t step = 1; step <= fields.size(); ++step) {
    const std::size_t g = (largest + step) % fields.size();
    own.genus = g == largest ? options.genus : std::nullopt;
    own.vertices = std::max<Index>(8, static_cast<Index>(std::lround(options.vertices * area_of(fields[g]) / area)));
    if (own.genus) {
      for (const FoundContour& other : found) {
        for (const FirstMeshPart& part : mesh_parts(other.mesh)) *own.genus -= part.genus;
      }
    }
    const double count = static_cast<double>(fields.size());
    found[g] = find_contour(fields[g], own,
                            progress_within(progress, 0.7 + 0.3 * (step - 1) / count, 0.7 + 0.3 * step / count));
  }
  FirstMesh result;
  for (std::size_t g = 0; g < fields.size(); ++g) append_contour(result, found[g], fields[g]);
  result.outliers += static_cast<Index>(cloud.points.rows()) - in_groups;
  result.spacing = found[largest].spacing * fields[largest].samples.size;
  result.point_spacing = fields[largest].samples.typical * fields[largest].samples.size;
  report_progress(progress, 1.0);
  return result;
}

}  // namespace batten
