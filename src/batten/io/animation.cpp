#include "batten/io/animation.h"

#include <cmath>

#include "batten/error.h"
#include "batten/io/formats.h"
#include "batten/io/io.h"
#include "batten/io/write_check.h"
#include "batten/output.h"

namespace batten {
namespace {

void require_rows(const std::string& name, ConstValuesRef values, Eigen::Index rows, Eigen::Index other,
                  const std::string& what) {
  if ((values.rows() != rows && values.rows() != other) || values.cols() != 3) {
    throw Error(ErrorCode::BadShape, name + ": " + what + " must have " + std::to_string(rows) +
                                         " rows of three, not " + std::to_string(values.rows()) + " by " +
                                         std::to_string(values.cols()));
  }
  if (!values.allFinite()) throw Error(ErrorCode::NotFinite, name + ": " + what + " are not finite");
}

void require_targets(const std::string& name, const Mesh& mesh, const MorphTargets& targets) {
  const std::size_t count = targets.displacements.size();
  const auto corners = static_cast<Eigen::Index>(mesh.face_vertices.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Points& moved = targets.displacements[i];
    require_rows(name, moved, mesh.vertex_count(), mesh.vertex_count(),
                 "the displacements of morph target " + std::to_string(i));
  }
  if (!targets.normals.empty() && targets.normals.size() != count) {
    throw Error(ErrorCode::BadShape, name + ": " + std::to_string(targets.normals.size()) +
                                         " morph targets have normals and " + std::to_string(count) +
                                         " displacements; give normals for all or none");
  }
  for (std::size_t i = 0; i < targets.normals.size(); ++i) {
    require_rows(name, targets.normals[i], mesh.vertex_count(), corners,
                 "the normals of morph target " + std::to_string(i));
  }
  if (count == 0 || targets.times.empty() ||
      targets.weights.rows() != static_cast<Eigen::Index>(targets.times.size()) ||
      targets.weights.cols() != static_cast<Eigen::Index>(count)) {
    throw Error(ErrorCode::BadShape, name + ": an animation needs a target and a time, and a weight for each of both");
  }
  if (!targets.weights.allFinite()) throw Error(ErrorCode::NotFinite, name + ": a morph target's weight is not finite");
  double before = -1.0;
  for (const double time : targets.times) {
    if (!std::isfinite(time) || time < 0.0 || time <= before) {
      throw Error(ErrorCode::BadArgument, name + ": the times of an animation must rise from 0 or more, and " +
                                              std::to_string(time) + " does not");
    }
    before = time;
  }
}

}  // namespace

void write_animation(const std::string& path, const Mesh& mesh, const MorphTargets& targets,
                     const WriteOptions& options, const Progress& progress) {
  const std::string name = path == "-" ? "standard output" : path;
  const std::string kind = file_format(path, options.format);
  if (kind != "glb") throw Error(ErrorCode::UnknownFormat, name + ": only glb holds animations, not " + kind);
  io::require_writable(name, mesh);
  require_targets(name, mesh, targets);
#ifdef BATTEN_WITH_GLTF
  write_atomically(path, [&](const std::string& temporary) {
    io::OutputFile file(temporary, name, progress);
    io::write_glb(file, mesh, io::up_axis_to_write(mesh, options.up), &targets);
    file.close();
  });
#else
  (void)progress;
  throw Error(ErrorCode::NotAvailable, name + ": this build writes no GLB; configure with BATTEN_WITH_GLTF=ON");
#endif
}

}  // namespace batten
