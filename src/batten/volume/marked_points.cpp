#include "batten/volume/marked_points.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/io/json_place.h"
#include "batten/io/scanner.h"
#include "batten/io/source.h"
#include "batten/progress.h"

namespace batten {

namespace {

using Placed = std::vector<Eigen::RowVector3d>;

bool ends_like(const std::string& path, std::string_view end) {
  if (path.size() < end.size()) return false;
  return std::equal(end.rbegin(), end.rend(), path.rbegin(), [](char wanted, char given) {
    return wanted == (given >= 'A' && given <= 'Z' ? static_cast<char>(given - 'A' + 'a') : given);
  });
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

Points stacked(const std::string& name, const Placed& placed) {
  if (placed.empty()) throw Error(ErrorCode::BadFile, name + ": there are no points in it");
  io::require_index_count(name, placed.size(), "points");
  Points points(static_cast<Eigen::Index>(placed.size()), 3);
  for (std::size_t row = 0; row < placed.size(); ++row) points.row(static_cast<Eigen::Index>(row)) = placed[row];
  return points;
}

/// The points of one list.
void add_list(const io::JsonPlace& list, Placed& placed) {
  const std::vector<std::string> types{"Fiducial", "Curve", "ClosedCurve", "Line", "Angle", "Plane", "ROI"};
  constexpr std::size_t kOnBorders = 3;
  if (list.at("type").choice(types) >= kOnBorders)
    list.at("type").fail("points on a border are a point list (Fiducial), a Curve or a ClosedCurve");
  if (list.has("coordinateUnits")) list.at("coordinateUnits").choice({"mm"});
  const bool is_lps = list.at("coordinateSystem").choice({"RAS", "LPS"}) == 1;
  const io::JsonPlace points = list.at("controlPoints");
  for (std::size_t n = 0; n < points.size(); ++n) {
    const io::JsonPlace point = points.item(n);
    const std::vector<std::string> statuses{"defined", "undefined", "preview", "missing"};
    if (point.has("positionStatus") && point.at("positionStatus").choice(statuses) != 0) continue;
    Eigen::RowVector3d place = point.at("position").vector().transpose();
    if (is_lps) place.head<2>() *= -1.0;
    placed.push_back(place);
  }
}

Points points_of_markups(const std::string& name, std::string_view text) {
  const io::JsonName names{name, "list of markups"};
  const io::Json json = io::parse_json(names, text);
  const io::JsonPlace document(names, json);
  const io::JsonPlace lists = document.at("markups");
  Placed placed;
  for (std::size_t n = 0; n < lists.size(); ++n) add_list(lists.item(n), placed);
  return stacked(name, placed);
}

/// LPS where `# CoordinateSystem = LPS` or 1 says so; RAS is 0. Nothing for other comments.
std::optional<WorldSpace> space_of_comment(std::string_view line) {
  const std::size_t sign = line.find('=');
  if (sign == std::string_view::npos || trimmed(line.substr(1, sign - 1)) != "CoordinateSystem") return {};
  const std::string_view value = trimmed(line.substr(sign + 1));
  if (value == "LPS" || value == "1") return WorldSpace::Lps;
  if (value == "RAS" || value == "0") return WorldSpace::Ras;
  throw io::Fault{line.data(), ErrorCode::BadFile,
                  "the coordinate system " + io::in_quotes(value) + " is neither LPS nor RAS"};
}

/// The second to the fourth of the numbers between commas.
Eigen::RowVector3d place_of_line(std::string_view line) {
  const char* const names[] = {"x", "y", "z"};
  Eigen::RowVector3d place;
  std::size_t comma = line.find(',');
  for (int c = 0; c < 3; ++c) {
    if (comma == std::string_view::npos)
      throw io::Fault{line.data() + line.size(), ErrorCode::BadFile, std::string("missing ") + names[c]};
    const std::string_view rest = line.substr(comma + 1);
    io::Scanner scanner(rest.substr(0, rest.find(',')));
    place(c) = scanner.coordinate(names[c]);
    scanner.finish_line();
    comma = line.find(',', comma + 1);
  }
  return place;
}

Points points_of_table(const std::string& name, std::string_view text) {
  const io::Source source{name, text};
  std::optional<WorldSpace> space;
  Placed placed;
  try {
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::string_view line = trimmed(text.substr(begin, end - begin));
      begin = end + 1;
      if (line.empty()) continue;
      if (line.front() != '#') {
        placed.push_back(place_of_line(line));
      } else if (const std::optional<WorldSpace> said = space_of_comment(line)) {
        space = said;
      }
    }
  } catch (const io::Fault& fault) {
    io::throw_at_line(source, fault);
  }
  Points points = stacked(name, placed);
  if (!space)
    throw Error(ErrorCode::BadFile, name +
                                        ": it does not say its world; give it a line # CoordinateSystem = LPS, or "
                                        "RAS, whichever it is");
  return in_space(std::move(points), *space);
}

}  // namespace

bool is_marked_points_path(const std::string& path) { return ends_like(path, ".mrk.json") || ends_like(path, ".fcsv"); }

Points marked_points(const std::string& name, std::string_view text) {
  const std::string_view shown = trimmed(text);
  return !shown.empty() && shown.front() == '{' ? points_of_markups(name, text) : points_of_table(name, text);
}

Points read_marked_points(const std::string& path, const Progress& progress) {
  const io::InputFile file(path, progress);
  return marked_points(path, file.bytes());
}

}  // namespace batten
