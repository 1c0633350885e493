#include <fmt/format.h>

#include "batten/error.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {
namespace {

std::string name_of(const std::optional<TexturePreset>& preset) {
  for (const auto& named : kTexturePresets) {
    if (preset == named.first) return named.second;
  }
  return "noise";
}

Texture texture_of(const TextureArguments& arguments) {
  std::optional<ColorRamp> ramp;
  if (!arguments.colors.empty()) ramp.emplace(arguments.colors);
  if (arguments.preset) {
    Texture texture = preset_texture(*arguments.preset, arguments.noise);
    if (ramp) texture.ramp = *ramp;
    return texture;
  }
  NoiseOptions noise;
  noise.seed = arguments.noise.seed;
  if (arguments.noise.frequency > 0.0) noise.frequency = arguments.noise.frequency;
  if (arguments.noise.octaves > 0) noise.octaves = arguments.noise.octaves;
  if (arguments.noise.gain >= 0.0) noise.gain = arguments.noise.gain;
  const std::vector<std::array<double, 3>> greys{{0.05, 0.05, 0.05}, {0.95, 0.95, 0.95}};
  return plain_texture(noise, ramp ? *ramp : ColorRamp(greys));
}

/// What is drawn and what stays the same for all textures of a run.
struct Canvas {
  const Mesh& mesh;
  const Topology& topology;
  Scheme scheme;
  TextureOptions options;
};

Mesh textured(const Canvas& canvas, const Texture& texture, bool quiet) {
  return textured_surface(canvas.topology, canvas.scheme, canvas.mesh, texture, canvas.options,
                          ProgressBar("texturing", quiet).callback());
}

Subject subject_of(const Canvas& canvas, const Mesh& colored) {
  Subject subject;
  subject.control = &colored;
  subject.flat = true;
  subject.before = &canvas.mesh;
  subject.before_caption = "the mesh given";
  return subject;
}

void draw_gallery(const TextureArguments& arguments, const Canvas& canvas, Job& job) {
  std::vector<Subject> subjects;
  std::vector<Mesh> surfaces;
  surfaces.reserve(std::size(kTexturePresets));
  for (const auto& named : kTexturePresets) {
    surfaces.push_back(textured(canvas, preset_texture(named.first, arguments.noise), arguments.common.quiet));
    subjects.push_back(subject_of(canvas, surfaces.back()));
    subjects.back().after_caption = named.second;
  }
  PictureArguments picture = arguments.picture;
  picture.path = arguments.gallery;
  draw_row(subjects, picture, job);
}

}  // namespace

int run_texture(const TextureArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("texture", common);
  const Mesh& mesh = job.mesh;
  const Topology topology = job.connect();
  Canvas canvas{mesh, topology, scheme_for(common, mesh), {}};
  canvas.options.levels = arguments.levels >= 0 ? arguments.levels : picture_levels(topology);
  canvas.options.flat = arguments.flat;
  if (arguments.displace) {
    canvas.options.displacement =
        arguments.displace->value * (arguments.displace->relative ? bounding_diagonal(mesh.points) : 1.0);
  }
  const Texture texture = texture_of(arguments);
  const Mesh colored = textured(canvas, texture, common.quiet);
  job.stages.finish("texture");
  job.write(colored);
  if (!arguments.picture.path.empty()) {
    Subject subject = subject_of(canvas, colored);
    subject.after_caption = name_of(arguments.preset);
    draw(subject, arguments.picture, job);
    job.stages.finish("picture");
  }
  if (!arguments.gallery.empty()) {
    draw_gallery(arguments, canvas, job);
    job.stages.finish("gallery");
  }
  const NoiseOptions& noise = texture.noises.front();
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", scheme_text(canvas.scheme));
  table.add("texture",
            fmt::format("{}, seed {}, frequency {:g}, {}, gain {:g}", name_of(arguments.preset), arguments.noise.seed,
                        noise.frequency, count_of(noise.octaves, "octave", "octaves"), noise.gain));
  table.add("coloured", size_text(colored) + (arguments.flat ? ", the mesh as it is" : ", on the limit surface"));
  if (arguments.displace) table.add("displaced", fmt::format("{:.4g} times the noise", canvas.options.displacement));
  job.print(table);
  job.report({{"scheme", scheme_json(canvas.scheme)},
              {"texture", name_of(arguments.preset)},
              {"seed", arguments.noise.seed},
              {"frequency", noise.frequency},
              {"octaves", noise.octaves},
              {"gain", noise.gain},
              {"levels", arguments.flat ? 0 : canvas.options.levels},
              {"flat", arguments.flat},
              {"displacement", canvas.options.displacement},
              {"vertices", colored.vertex_count()},
              {"faces", colored.face_count()}});
  return 0;
}

}  // namespace batten::cli
