#include <cstdint>
#include <utility>

#include "batten/medial/medial_formats.h"

namespace batten::medial {

namespace {

/// A spoke in LPS.
struct FileSpoke {
  Eigen::Vector3d origin;
  Eigen::Vector3d spoke;
};

/// A point or a direction in LPS: RAS counts the first two numbers the other way.
Eigen::Vector3d read_vector(const JsonPlace& place) {
  const JsonPlace system_place = place.at("CoordinateSystem");
  const std::string system = system_place.text();
  const JsonPlace value = place.at("Value");
  Eigen::Vector3d vector = value.vector();
  if (system == "LPS") return vector;
  if (system == "RAS") return {-vector.x(), -vector.y(), vector.z()};
  system_place.fail("'" + system.substr(0, 40) + "' is an unknown coordinate system; LPS or RAS is expected");
}

FileSpoke read_spoke(const JsonPlace& point, const char* key) {
  const JsonPlace spoke = point.at(key);
  FileSpoke read{read_vector(spoke.at("SkeletalPoint")), read_vector(spoke.at("Direction"))};
  if (!(read.spoke.norm() > 0.0)) spoke.at("Direction").fail("the length of the spoke is 0");
  return read;
}

/// One point of a line; those of the spine are met twice.
class PointReader {
 public:
  PointReader(MedialFigure& figure, const SpineGrid& grid)
      : figure_(figure), grid_(grid), filled_(static_cast<std::size_t>(grid.atom_count()), 0) {
    figure.sheet.points.resize(grid.atom_count(), 3);
    figure.up.resize(grid.atom_count(), 3);
    figure.down.resize(grid.atom_count(), 3);
    figure.crest.resize(static_cast<std::size_t>(grid.crest_points));
  }

  void read(const JsonPlace& point, Index line, Index step) {
    const FileSpoke up = read_spoke(point, "UpSpoke");
    const FileSpoke down = read_spoke(point, "DownSpoke");
    if (!near(up.origin, down.origin, up.spoke.norm())) point.fail("UpSpoke and DownSpoke start from different points");
    const Index atom = grid_.atom(line, step);
    const bool is_crest = step == grid_.steps;
    if (is_crest) {
      const FileSpoke crest = read_spoke(point, "CrestSpoke");
      figure_.crest[static_cast<std::size_t>(line)] = {atom, crest.origin, crest.spoke};
    } else if (point.has("CrestSpoke")) {
      point.fail("only the last step of a line has a CrestSpoke");
    }
    if (filled_[static_cast<std::size_t>(atom)] != 0) return require_same(point, atom, up, down, line);
    filled_[static_cast<std::size_t>(atom)] = 1;
    figure_.sheet.points.row(atom) = up.origin.transpose();
    figure_.up.row(atom) = up.spoke.transpose();
    figure_.down.row(atom) = down.spoke.transpose();
  }

 private:
  /// Files have six digits or more.
  static bool near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double length) {
    constexpr double kDigits = 1e-5;
    return (a - b).norm() <= kDigits * (length + a.norm());
  }
  void require_same(const JsonPlace& point, Index atom, const FileSpoke& up, const FileSpoke& down, Index line) const {
    const double length = up.spoke.norm();
    const bool same = near(up.origin, figure_.sheet.points.row(atom).transpose(), length) &&
                      near(up.spoke, figure_.up.row(atom).transpose(), length) &&
                      near(down.spoke, figure_.down.row(atom).transpose(), length);
    if (same) return;
    point.fail("this point of the spine differs from that of line " + std::to_string(grid_.crest_points - line) +
               ", step 0, which is the same point");
  }

  MedialFigure& figure_;
  SpineGrid grid_;
  std::vector<std::uint8_t> filled_;
};

Json vector_json(const Eigen::Vector3d& vector) {
  return {{"CoordinateSystem", "LPS"}, {"Value", {vector.x(), vector.y(), vector.z()}}};
}

Json spoke_json(const Eigen::Vector3d& origin, const Eigen::Vector3d& spoke) {
  return {{"SkeletalPoint", vector_json(origin)}, {"Direction", vector_json(spoke)}};
}

}  // namespace

MedialModel srep_from_json(const JsonPlace& document) {
  const JsonPlace srep = document.at("EllipticalSRep");
  const JsonPlace crest_place = srep.at("CrestPoints");
  const SpineGrid grid{crest_place.index(), srep.at("Steps").index()};
  const JsonPlace skeleton = srep.at("Skeleton");
  const auto lines = static_cast<std::size_t>(grid.crest_points);
  const std::size_t points = static_cast<std::size_t>(grid.steps) + 1;
  if (skeleton.size() != lines) {
    skeleton.fail((skeleton.size() < lines ? "line " + std::to_string(skeleton.size()) + " is missing: " : "") +
                  "CrestPoints says " + std::to_string(lines) + ", and Skeleton has " +
                  std::to_string(skeleton.size()) + " lines");
  }
  for (std::size_t line = 0; line < lines; ++line) {
    const JsonPlace place = skeleton.item(line);
    if (place.size() == points) continue;
    place.fail((place.size() < points ? "step " + std::to_string(place.size()) + " is missing: " : "") + "Steps says " +
               std::to_string(grid.steps) + ", so a line has " + std::to_string(points) + " points, not " +
               std::to_string(place.size()));
  }
  MedialModel model;
  MedialFigure& figure = model.figures.emplace_back();
  try {
    set_ellipse(figure, grid);
  } catch (const Error& error) {
    crest_place.fail(error.what());
  }
  PointReader reader(figure, grid);
  for (Index line = 0; line < grid.crest_points; ++line) {
    const JsonPlace line_place = skeleton.item(static_cast<std::size_t>(line));
    for (Index step = 0; step <= grid.steps; ++step)
      reader.read(line_place.item(static_cast<std::size_t>(step)), line, step);
  }
  return model;
}

Json srep_to_json(const MedialFigure& figure) {
  const SpineGrid grid = *figure.grid;
  std::vector<const CrestSpoke*> crest(static_cast<std::size_t>(figure.atom_count()), nullptr);
  for (const CrestSpoke& one : figure.crest) crest[static_cast<std::size_t>(one.atom)] = &one;
  Json skeleton = Json::array();
  for (Index line = 0; line < grid.crest_points; ++line) {
    Json points = Json::array();
    for (Index step = 0; step <= grid.steps; ++step) {
      const Index atom = grid.atom(line, step);
      const Eigen::Vector3d origin = figure.sheet.points.row(atom).transpose();
      Json point{{"UpSpoke", spoke_json(origin, figure.up.row(atom).transpose())},
                 {"DownSpoke", spoke_json(origin, figure.down.row(atom).transpose())}};
      if (const CrestSpoke* one = crest[static_cast<std::size_t>(atom)]; one != nullptr)
        point["CrestSpoke"] = spoke_json(one->origin, one->spoke);
      points.push_back(std::move(point));
    }
    skeleton.push_back(std::move(points));
  }
  Json srep;
  srep["CrestPoints"] = grid.crest_points;
  srep["Steps"] = grid.steps;
  srep["Skeleton"] = std::move(skeleton);
  Json document;
  document["EllipticalSRep"] = std::move(srep);
  return document;
}

}  // namespace batten::medial
