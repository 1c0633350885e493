#include "batten/medial/medial_io.h"

#include <algorithm>
#include <string_view>

#include "batten/io/gzip.h"
#include "batten/io/source.h"
#include "batten/medial/medial_formats.h"
#include "batten/output.h"
#include "batten/progress.h"

namespace batten {

namespace {

bool ends_with(const std::string& path, std::string_view end) {
  if (path.size() < end.size()) return false;
  return std::equal(end.rbegin(), end.rend(), path.rbegin(), [](char wanted, char given) {
    return wanted == (given >= 'A' && given <= 'Z' ? static_cast<char>(given - 'A' + 'a') : given);
  });
}

}  // namespace

MedialModel medial::model_from_text(const std::string& name, std::string_view text) {
  const io::JsonName names{name, "medial model", place_text};
  const Json json = io::parse_json(names, text);
  const JsonPlace document(names, json);
  if (!document.has("EllipticalSRep") && !document.has("figures"))
    document.fail("a medial model has EllipticalSRep (3D Slicer's s-reps) or figures (Batten's) at its top");
  MedialModel model = document.has("figures") ? medial::figures_from_json(document) : medial::srep_from_json(document);
  require_medial(model);
  return model;
}

bool is_srep_path(const std::string& path) { return ends_with(path, ".srep.json"); }

MedialModel read_medial(const std::string& path, const Progress& progress) {
  const io::InputFile file(path, progress);
  const std::string name = path == "-" ? "standard input" : path;
  const io::Source source{name, file.bytes()};
  try {
    if (!io::is_gzip(source.bytes)) return medial::model_from_text(name, source.bytes);
    const Buffer<char> unpacked = io::unpack_gzip(source);
    return medial::model_from_text(name, {unpacked.data(), unpacked.size()});
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.rfind(name + ":", 0) == 0) throw;
    throw Error(error.code(), name + ": " + message);
  }
}

void require_medial_format(const std::string& path, const MedialModel& model) {
  const bool srep = is_srep_path(path);
  if (!srep && path != "-" && !io::is_special_target(path) && !ends_with(path, ".json"))
    throw Error(ErrorCode::UnknownFormat, path + ": a medial model is written as .srep.json or .json");
  if (srep && (model.figures.size() != 1 || !model.figures.front().grid)) {
    throw Error(ErrorCode::BadArgument,
                path + ": an .srep.json holds one figure on an elliptical grid; write .json instead");
  }
}

void write_medial(const std::string& path, const MedialModel& model) {
  require_medial(model);
  require_medial_format(path, model);
  const medial::Json json =
      is_srep_path(path) ? medial::srep_to_json(model.figures.front()) : medial::figures_to_json(model);
  const std::string text = io::json_text(json);
  write_bytes(path, Buffer<unsigned char>(text.begin(), text.end()));
}

std::vector<std::string> find_medial_losses(const std::string& path, const MedialModel& model) {
  const auto some_figure = [&](const auto& has) {
    return std::any_of(model.figures.begin(), model.figures.end(), has);
  };
  std::vector<std::string> lost;
  if (is_srep_path(path)) {
    if (some_figure([](const MedialFigure& figure) { return !figure.name.empty(); }))
      lost.push_back("the figure's name");
  } else if (some_figure([](const MedialFigure& figure) { return figure.grid.has_value(); })) {
    lost.push_back("the order of the atoms in lines and steps");
  }
  return lost;
}

}  // namespace batten
