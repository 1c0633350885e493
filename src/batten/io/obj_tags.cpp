/// OpenSubdiv's tags: `t NAME i/f/s INTEGERS... NUMBERS... WORDS...`, with the three counts before the values.
#include <limits>

#include "batten/io/obj_parser.h"

namespace batten::io {

namespace {

struct TagCounts {
  std::int64_t integers;
  std::int64_t numbers;
  std::int64_t words;
};

TagCounts read_counts(Scanner& scanner) {
  TagCounts counts{};
  const char* where = scanner.position();
  counts.integers = scanner.integer("number of integers of a tag", '/');
  bool complete = scanner.skip('/');
  if (complete) counts.numbers = scanner.integer("number of numbers of a tag", '/');
  complete = complete && scanner.skip('/');
  if (complete) counts.words = scanner.integer("number of words of a tag");
  if (!complete || counts.integers < 0 || counts.numbers < 0 || counts.words < 0) {
    throw Fault{where, ErrorCode::BadFile,
                "the counts of a tag look like 2/1/0 (integers/numbers/words); correct them"};
  }
  return counts;
}

void require_counts(const Scanner& scanner, bool right, const char* form) {
  if (!right)
    scanner.fail(ErrorCode::BadFile, std::string("this tag has the form `t ") + form + "`; correct its counts");
}

std::vector<Index> read_elements(Scanner& scanner, std::int64_t count) {
  std::vector<Index> elements;
  for (std::int64_t i = 0; i < count; ++i) {
    scanner.next_token();
    const std::int64_t element = scanner.integer("element of a tag");
    if (element < 0 || element > std::numeric_limits<Index>::max()) {
      scanner.fail(ErrorCode::IndexOutOfRange,
                   "a tag names element " + std::to_string(element) + "; tags count from 0 (not 1)");
    }
    elements.push_back(static_cast<Index>(element));
  }
  return elements;
}

double read_sharpness(Scanner& scanner) {
  const double sharpness = scanner.coordinate("sharpness");
  if (sharpness < 0) scanner.fail(ErrorCode::BadFile, "a sharpness is 0 or more; correct this line");
  return sharpness;
}

/// Reads one sharpness for all, or one for each.
std::vector<double> read_sharpnesses(Scanner& scanner, std::int64_t given, std::size_t wanted) {
  std::vector<double> sharpness;
  for (std::int64_t i = 0; i < given; ++i) sharpness.push_back(read_sharpness(scanner));
  if (given == 1) sharpness.resize(wanted, sharpness[0]);
  return sharpness;
}

/// Reads two vertices, or a chain of them.
void read_crease(Scanner& scanner, const TagCounts& counts, ObjPiece& piece) {
  const bool right = counts.integers >= 2 && (counts.numbers == 1 || counts.numbers == counts.integers - 1);
  require_counts(scanner, right && counts.words == 0, "crease 2/1/0 VERTEX VERTEX SHARPNESS");
  const char* where = scanner.position();
  const std::vector<Index> chain = read_elements(scanner, counts.integers);
  const std::vector<double> sharpness = read_sharpnesses(scanner, counts.numbers, chain.size() - 1);
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    piece.creases.push_back({{chain[i], chain[i + 1], sharpness[i]}, where});
  }
}

void read_corner(Scanner& scanner, const TagCounts& counts, ObjPiece& piece) {
  const bool right = counts.integers >= 1 && (counts.numbers == 1 || counts.numbers == counts.integers);
  require_counts(scanner, right && counts.words == 0, "corner 1/1/0 VERTEX SHARPNESS");
  const char* where = scanner.position();
  const std::vector<Index> vertices = read_elements(scanner, counts.integers);
  const std::vector<double> sharpness = read_sharpnesses(scanner, counts.numbers, vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) piece.corners.push_back({{vertices[i], sharpness[i]}, where});
}

void read_holes(Scanner& scanner, const TagCounts& counts, ObjPiece& piece) {
  require_counts(scanner, counts.numbers == 0 && counts.words == 0, "hole 1/0/0 FACE");
  const char* where = scanner.position();
  for (const Index face : read_elements(scanner, counts.integers)) piece.holes.push_back({face, where});
}

void read_boundary(Scanner& scanner, const TagCounts& counts, ObjPiece& piece) {
  const char* form = "interpolateboundary 1/0/0 0|1|2";
  require_counts(scanner, counts.integers == 1 && counts.numbers == 0 && counts.words == 0, form);
  constexpr BoundaryRule kRules[] = {BoundaryRule::None, BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly};
  const Index rule = read_elements(scanner, 1)[0];
  require_counts(scanner, rule <= 2, form);
  piece.boundary = kRules[rule];
}

/// The rules stand in OpenSubdiv's order.
void read_face_varying(Scanner& scanner, const TagCounts& counts, ObjPiece& piece) {
  const char* form = "facevaryinginterpolateboundary 1/0/0 0|1|2|3|4|5";
  require_counts(scanner, counts.integers == 1 && counts.numbers == 0 && counts.words == 0, form);
  const Index rule = read_elements(scanner, 1)[0];
  require_counts(scanner, rule <= static_cast<Index>(FaceVaryingRule::All), form);
  piece.face_varying = static_cast<FaceVaryingRule>(rule);
}

/// Reads one of two words. "uniform" and "normal" are OpenSubdiv's and RenderMan's names of the plain rule.
bool read_choice(Scanner& scanner, const TagCounts& counts, const char* form, std::string_view plain,
                 std::string_view other) {
  require_counts(scanner, counts.integers == 0 && counts.numbers == 0 && counts.words == 1, form);
  const std::string_view word = scanner.word();
  require_counts(scanner, word == plain || word == "normal" || word == "uniform" || word == other, form);
  return word == other;
}

}  // namespace

void parse_obj_tag(Scanner& scanner, ObjPiece& piece) {
  const std::string_view name = scanner.word();
  if (name != "crease" && name != "corner" && name != "hole" && name != "interpolateboundary" &&
      name != "facevaryinginterpolateboundary" && name != "creasemethod" && name != "smoothtriangles") {
    return;
  }
  const TagCounts counts = read_counts(scanner);
  if (name == "crease") {
    read_crease(scanner, counts, piece);
  } else if (name == "corner") {
    read_corner(scanner, counts, piece);
  } else if (name == "hole") {
    read_holes(scanner, counts, piece);
  } else if (name == "interpolateboundary") {
    read_boundary(scanner, counts, piece);
  } else if (name == "facevaryinginterpolateboundary") {
    read_face_varying(scanner, counts, piece);
  } else if (name == "creasemethod") {
    const bool chaikin = read_choice(scanner, counts, "creasemethod 0/0/1 normal|chaikin", "normal", "chaikin");
    piece.crease_method = chaikin ? CreaseMethod::Chaikin : CreaseMethod::Uniform;
  } else {
    const bool smooth = read_choice(scanner, counts, "smoothtriangles 0/0/1 catmark|smooth", "catmark", "smooth");
    piece.triangle_rule = smooth ? TriangleRule::Smooth : TriangleRule::Catmark;
  }
  if (scanner.next_token()) scanner.fail_token("the end of the tag", "its counts promise fewer values");
}

}  // namespace batten::io
