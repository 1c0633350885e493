/// What the page asks a surface for: fields, places, distances.
#include <utility>

#include "batten/expand/surface_fields.h"
#include "batten/expand/texture.h"
#include "batten/mesh/topology.h"
#include "batten/nearest/surface_distances.h"
#include "studio/engine/colors.h"
#include "studio/engine/surface.h"

namespace batten::studio {
namespace {

struct FieldWish {
  SurfaceField field;
  ScaleRequest scale;
};

/// As the tool's --color words.
FieldWish field_of(const std::string& word, SchemeKind kind) {
  if (word == "error") return {SurfaceField::Missed, {"error", "in the mesh's unit", ColorMap::Sequential, 0.0, true}};
  if (word == "moved") return {SurfaceField::Moved, {"distance moved", "in the mesh's unit"}};
  if (word == "mean") return {SurfaceField::MeanCurvature, {"mean curvature", "1 / unit", ColorMap::Diverging}};
  if (word == "gaussian")
    return {SurfaceField::GaussianCurvature, {"Gaussian curvature", "1 / unit²", ColorMap::Diverging}};
  if (word == "valence") {
    const double regular = kind == SchemeKind::CatmullClark ? 4.0 : 6.0;
    return {SurfaceField::Valence, {"valence", "", ColorMap::Diverging, regular, false, true}};
  }
  if (word != "sharpness") throw Error(ErrorCode::BadArgument, "there is no measure called " + word);
  ScaleRequest sharpness{"sharpness", "levels; 10: for ever"};
  sharpness.outliers = 0.0;
  return {SurfaceField::Sharpness, sharpness};
}

val triple(const Eigen::Vector3d& vector) { return typed_array(vector.data(), 3); }

}  // namespace

val Surface::field(const std::string& word) {
  return guarded([&] {
    prepare();
    const FieldWish wish = field_of(word, scheme_.kind);
    const FieldSurface surface{topology_, scheme_, control_, &targets_};
    return colored(adaptive_ ? adaptive_field(surface, wish.field, *adaptive_, wishes_.chord)
                             : surface_field(surface, wish.field, levels_),
                   wish.scale);
  });
}

val Surface::texture(int preset, int seed) {
  return guarded([&] {
    prepare();
    if (adaptive_)
      throw Error(ErrorCode::BadArgument, "a texture is drawn by steps of detail, not by a tolerance: set it to none");
    PresetOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    TextureOptions asked;
    asked.levels = levels_;
    Mesh control = mesh_from_topology(topology_);
    control.points = control_;
    const Mesh colored = textured_surface(topology_, scheme_, control,
                                          preset_texture(static_cast<TexturePreset>(preset), options), asked);
    for (const Attribute& attribute : colored.attributes)
      if (attribute.name == "color") return typed_array(to_floats(attribute.values));
    throw Error(ErrorCode::BadShape, "the texture gave no colours");
  });
}

val Surface::probe(double x, double y, double z) {
  return guarded([&] {
    prepare();
    if (!nearest_) {
      nearest_.emplace(*patches_, control_);
      limit_.emplace(*patches_, control_);
    } else if (!is_current_) {
      nearest_->set_control(control_);
      limit_->set_control(control_);
    }
    is_current_ = true;
    const NearestPoint found = nearest_->nearest({x, y, z});
    const Jet jet = limit_->jet(found.place);
    const PointCurvature curvature = curvature_of(jet);
    val result = val::object();
    result.set("face", patches_->control_face(found.place.face));
    result.set("baseFace", found.place.face);
    result.set("hasFirstStep", patches_->has_first_step());
    for (const auto& [name, number] :
         {std::pair{"u", found.place.u}, std::pair{"v", found.place.v}, std::pair{"mean", curvature.mean},
          std::pair{"gaussian", curvature.gaussian}, std::pair{"greatest", curvature.greatest},
          std::pair{"least", curvature.least}, std::pair{"distance", found.distance}})
      result.set(name, number);
    result.set("point", triple(jet.point));
    result.set("normal", triple(curvature.normal));
    return result;
  });
}

val Surface::distances(const val& points) {
  return guarded([&] {
    const SurfaceDistances measured = measure_distances(topology_, scheme_, control_, to_points(points));
    return colored(measured.distances.cwiseAbs(), {"distance", "in the mesh's unit"});
  });
}

}  // namespace batten::studio
