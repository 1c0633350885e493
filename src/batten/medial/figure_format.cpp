#include <string>
#include <utility>
#include <vector>

#include "batten/io/source.h"
#include "batten/medial/medial_formats.h"
#include "batten/mesh/topology.h"

namespace batten::medial {

namespace {

/// The lengths of the two spokes of an atom, where the file gives them apart from the directions.
struct AtomRadii {
  bool given = false;
  double up = 0.0;
  double down = 0.0;
};

AtomRadii read_radii(const JsonPlace& atom) {
  if (!atom.has("radius")) return {};
  const JsonPlace place = atom.at("radius");
  AtomRadii radii{true, 0.0, 0.0};
  if (place.is_list()) {
    const Eigen::Vector2d both = place.pair();
    radii.up = both.x();
    radii.down = both.y();
  } else {
    radii.up = place.number();
    radii.down = radii.up;
  }
  if (!(radii.up > 0.0 && radii.down > 0.0)) place.fail("the radius is not above 0");
  return radii;
}

Eigen::Vector3d read_spoke_of(const JsonPlace& atom, const char* key, bool has_radius, double radius) {
  const JsonPlace place = atom.at(key);
  const Eigen::Vector3d vector = place.vector();
  if (!(vector.norm() > 0.0)) place.fail("the length of the spoke is 0");
  return has_radius ? Eigen::Vector3d(radius * vector.normalized()) : vector;
}

void read_faces(const JsonPlace& place, MedialFigure& figure, std::size_t atoms) {
  if (place.has("grid")) {
    const JsonPlace grid = place.at("grid");
    if (place.has("faces")) grid.fail("the figure has both grid and faces; leave one out");
    if (grid.size() != 2) grid.fail("two whole numbers are expected here: rows and columns");
    const Index rows = grid.item(0).index();
    const Index columns = grid.item(1).index();
    if (rows < 2 || columns < 2 || static_cast<std::size_t>(rows) != atoms / columns || atoms % columns != 0) {
      grid.fail("a grid has 2 rows and columns or more, and as many atoms as their product; this figure has " +
                std::to_string(atoms) + " atoms");
    }
    return set_rectangle(figure, rows, columns);
  }
  const JsonPlace faces = place.at("faces");
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const JsonPlace face = faces.item(i);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index atom = face.item(k).index();
      if (static_cast<std::size_t>(atom) >= atoms)
        face.fail("atom " + std::to_string(atom) + " does not exist; there are " + std::to_string(atoms));
      figure.sheet.face_vertices.push_back(atom);
    }
    figure.sheet.face_offsets.push_back(static_cast<Index>(figure.sheet.face_vertices.size()));
  }
}

/// The crest spoke that the file gives, or that an elongation makes.
CrestSpoke read_crest(const JsonPlace& place, const MedialFigure& figure, Index atom) {
  const Eigen::Vector3d position = figure.sheet.points.row(atom).transpose();
  if (place.has("crest")) {
    const JsonPlace crest = place.at("crest");
    if (place.has("elongation")) crest.fail("the atom has both crest and elongation; leave one out");
    CrestSpoke read{atom, position, Eigen::Vector3d::Zero()};
    if (crest.is_object()) {
      crest.require_keys({"position", "spoke"});
      if (crest.has("position")) read.origin = crest.at("position").vector();
      read.spoke = crest.at("spoke").vector();
    } else {
      read.spoke = crest.vector();
    }
    if (!(read.spoke.norm() > 0.0)) crest.fail("the length of the spoke is 0");
    return read;
  }
  const double elongation = place.has("elongation") ? place.at("elongation").number() : 1.0;
  if (!(elongation > 0.0)) place.at("elongation").fail("the elongation is not above 0");
  const Eigen::Vector3d up = figure.up.row(atom).transpose();
  const Eigen::Vector3d down = figure.down.row(atom).transpose();
  const Eigen::Vector3d bisector = up.normalized() + down.normalized();
  constexpr double kOpposite = 1e-6;
  if (bisector.norm() < kOpposite)
    place.fail("the two spokes are opposite and have no bisector; give the crest spoke as \"crest\"");
  return {atom, position, elongation * 0.5 * (up.norm() + down.norm()) * bisector.normalized()};
}

/// The atoms at the edge of the sheet have a crest spoke, no other has one.
void read_crests(const JsonPlace& place, MedialFigure& figure) {
  const JsonPlace atoms = place.at("atoms");
  const Topology sheet(figure.sheet);
  for (Index atom = 0; atom < figure.atom_count(); ++atom) {
    const JsonPlace one = atoms.item(static_cast<std::size_t>(atom));
    if (sheet.is_isolated(atom)) one.fail("the atom is in no face of the sheet; leave it out or add one");
    if (sheet.is_boundary_vertex(atom)) {
      figure.crest.push_back(read_crest(one, figure, atom));
    } else if (one.has("crest") || one.has("elongation")) {
      one.fail("the atom is not at the edge of the sheet and has no crest spoke; leave it out");
    }
  }
}

void read_coordinates(const JsonPlace& atoms, MedialFigure& figure) {
  const std::size_t count = atoms.size();
  std::size_t given = 0;
  for (std::size_t i = 0; i < count; ++i) given += atoms.item(i).has("uv") ? 1 : 0;
  if (given == 0) return;
  figure.coordinates.resize(figure.sheet.points.rows(), 2);
  for (std::size_t i = 0; i < count; ++i) {
    const JsonPlace atom = atoms.item(i);
    figure.coordinates.row(static_cast<Eigen::Index>(i)) = atom.at("uv").pair().transpose();
  }
}

MedialFigure read_figure(const JsonPlace& place) {
  MedialFigure figure;
  place.require_keys({"name", "grid", "faces", "atoms"});
  if (place.has("name")) figure.name = place.at("name").text();
  const JsonPlace atoms = place.at("atoms");
  const std::size_t count = atoms.size();
  if (count == 0) atoms.fail("the figure has no atom");
  io::require_index_count("the figure", 8 * count, "atoms");
  read_faces(place, figure, count);
  const auto rows = static_cast<Eigen::Index>(count);
  figure.sheet.points.resize(rows, 3);
  figure.up.resize(rows, 3);
  figure.down.resize(rows, 3);
  for (std::size_t i = 0; i < count; ++i) {
    const JsonPlace atom = atoms.item(i);
    atom.require_keys({"position", "radius", "up", "down", "crest", "elongation", "uv"});
    const AtomRadii radii = read_radii(atom);
    const auto row = static_cast<Eigen::Index>(i);
    figure.sheet.points.row(row) = atom.at("position").vector().transpose();
    figure.up.row(row) = read_spoke_of(atom, "up", radii.given, radii.up).transpose();
    figure.down.row(row) = read_spoke_of(atom, "down", radii.given, radii.down).transpose();
  }
  read_coordinates(atoms, figure);
  read_crests(place, figure);
  return figure;
}

std::vector<Index> read_indices(const JsonPlace& list) {
  std::vector<Index> indices;
  for (std::size_t i = 0; i < list.size(); ++i) indices.push_back(list.item(i).index());
  return indices;
}

/// A figure by its number or its name.
Index read_figure_number(const JsonPlace& place, const MedialModel& model) {
  if (!place.is_text()) {
    const Index number = place.index();
    if (static_cast<std::size_t>(number) >= model.figures.size())
      place.fail("there is no figure " + std::to_string(number));
    return number;
  }
  const std::string name = place.text();
  for (std::size_t i = 0; i < model.figures.size(); ++i) {
    if (model.figures[i].name == name) return static_cast<Index>(i);
  }
  place.fail("no figure is called '" + name.substr(0, 40) + "'");
}

HingePlace read_hinge_place(const JsonPlace& place, const MedialModel& model) {
  HingePlace read;
  place.require_keys({"figure", "edge", "faces", "side"});
  read.figure = read_figure_number(place.at("figure"), model);
  if (place.has("edge")) {
    read.edge = read_indices(place.at("edge"));
    return read;
  }
  read.faces = read_indices(place.at("faces"));
  const JsonPlace side = place.at("side");
  const std::string word = side.text();
  if (word != "up" && word != "down") side.fail("a side is \"up\" or \"down\"");
  read.side = word == "up" ? SpokeSide::Up : SpokeSide::Down;
  return read;
}

Json hinge_place_json(const HingePlace& place) {
  Json json;
  json["figure"] = place.figure;
  if (!place.edge.empty()) {
    json["edge"] = place.edge;
    return json;
  }
  json["side"] = place.side == SpokeSide::Up ? "up" : "down";
  json["faces"] = place.faces;
  return json;
}

Json row_json(const Eigen::RowVector3d& row) { return Json::array({row.x(), row.y(), row.z()}); }

Json faces_json(const Mesh& sheet) {
  Json faces = Json::array();
  for (Index face = 0; face < sheet.face_count(); ++face) {
    faces.push_back(std::vector<Index>(sheet.face_vertices.begin() + sheet.face_offsets[face],
                                       sheet.face_vertices.begin() + sheet.face_offsets[face + 1]));
  }
  return faces;
}

Json crest_json(const CrestSpoke& crest, const Eigen::RowVector3d& position) {
  Json spoke = row_json(crest.spoke.transpose());
  if (crest.origin.transpose() == position) return spoke;
  Json json;
  json["position"] = row_json(crest.origin.transpose());
  json["spoke"] = std::move(spoke);
  return json;
}

Json figure_json(const MedialFigure& figure) {
  Json atoms = Json::array();
  for (Index atom = 0; atom < figure.atom_count(); ++atom) {
    Json json;
    json["position"] = row_json(figure.sheet.points.row(atom));
    json["up"] = row_json(figure.up.row(atom));
    json["down"] = row_json(figure.down.row(atom));
    if (figure.coordinates.rows() > 0)
      json["uv"] = Json::array({figure.coordinates(atom, 0), figure.coordinates(atom, 1)});
    atoms.push_back(std::move(json));
  }
  for (const CrestSpoke& crest : figure.crest)
    atoms[static_cast<std::size_t>(crest.atom)]["crest"] = crest_json(crest, figure.sheet.points.row(crest.atom));
  Json json;
  if (!figure.name.empty()) json["name"] = figure.name;
  json["faces"] = faces_json(figure.sheet);
  json["atoms"] = std::move(atoms);
  return json;
}

}  // namespace

MedialModel figures_from_json(const JsonPlace& document) {
  MedialModel model;
  document.require_keys({"figures", "hinges"});
  const JsonPlace figures = document.at("figures");
  for (std::size_t i = 0; i < figures.size(); ++i) model.figures.push_back(read_figure(figures.item(i)));
  if (model.figures.empty()) figures.fail("there is no figure");
  if (!document.has("hinges")) return model;
  const JsonPlace hinges = document.at("hinges");
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    const JsonPlace hinge = hinges.item(i);
    hinge.require_keys({"child", "parent"});
    model.hinges.push_back({read_hinge_place(hinge.at("child"), model), read_hinge_place(hinge.at("parent"), model)});
  }
  return model;
}

Json figures_to_json(const MedialModel& model) {
  Json figures = Json::array();
  for (const MedialFigure& figure : model.figures) figures.push_back(figure_json(figure));
  Json document;
  document["figures"] = std::move(figures);
  for (const MedialHinge& hinge : model.hinges) {
    Json json;
    json["child"] = hinge_place_json(hinge.child);
    json["parent"] = hinge_place_json(hinge.parent);
    document["hinges"].push_back(std::move(json));
  }
  return document;
}

}  // namespace batten::medial
