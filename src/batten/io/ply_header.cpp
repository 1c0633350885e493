#include "batten/io/ply_header.h"

#include <algorithm>

#include "batten/io/scanner.h"

namespace batten::io {

namespace {

struct TypeName {
  const char* name;
  PlyType type;
};

constexpr TypeName kTypeNames[] = {
    {"char", PlyType::Int8},       {"uchar", PlyType::Uint8},    {"short", PlyType::Int16},
    {"ushort", PlyType::Uint16},   {"int", PlyType::Int32},      {"uint", PlyType::Uint32},
    {"float", PlyType::Float32},   {"double", PlyType::Float64}, {"int8", PlyType::Int8},
    {"uint8", PlyType::Uint8},     {"int16", PlyType::Int16},    {"uint16", PlyType::Uint16},
    {"int32", PlyType::Int32},     {"uint32", PlyType::Uint32},  {"float32", PlyType::Float32},
    {"float64", PlyType::Float64}, {"int64", PlyType::Int64},    {"uint64", PlyType::Uint64},
};

class HeaderParser {
 public:
  explicit HeaderParser(const Source& source) : scanner_(source.bytes) {}

  PlyHeader parse() {
    if (scanner_.word() != "ply") scanner_.fail(ErrorCode::BadFile, "a PLY file begins with the line `ply`");
    scanner_.finish_line();
    while (!line()) {
    }
    if (!has_format_) scanner_.fail(ErrorCode::BadFile, "the header lacks a `format` line");
    header_.body = scanner_.position();
    return std::move(header_);
  }

 private:
  /// Returns true after end_header. That line ends right after LF, since any byte may follow.
  bool line() {
    if (scanner_.at_end()) scanner_.fail(ErrorCode::BadFile, "the header has no end_header; the file is cut short");
    const std::string_view keyword = scanner_.word();
    if (keyword == "comment" || keyword == "obj_info") {
      comment();
    } else if (keyword == "format") {
      format();
    } else if (keyword == "element") {
      element();
    } else if (keyword == "property") {
      property();
    } else if (!keyword.empty() && keyword != "end_header") {
      scanner_.fail(ErrorCode::BadFile, "unknown header line " + in_quotes(keyword));
    }
    scanner_.finish_line();
    return keyword == "end_header";
  }

  /// The rest of the line is no tokens: it may hold a Windows path that ends in a backslash.
  void comment() {
    const char* const begin = scanner_.position();
    scanner_.skip_comment();
    std::string_view text(begin, static_cast<std::size_t>(scanner_.position() - begin));
    text = text.substr(0, text.find('\r'));
    const auto trim = [&] {
      constexpr const char* kBlanks = " \t";
      text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
      text = text.substr(0, text.find_last_not_of(kBlanks) + 1);
    };
    trim();
    constexpr std::string_view kTextureFile = "TextureFile";
    if (text.substr(0, kTextureFile.size() + 1) != std::string(kTextureFile) + ' ') return;
    text.remove_prefix(kTextureFile.size());
    trim();
    if (!text.empty()) header_.texture_files.emplace_back(text);
  }

  void format() {
    const std::string_view word = scanner_.word();
    if (word == "ascii") {
      header_.encoding = PlyEncoding::Text;
    } else if (word == "binary_little_endian") {
      header_.encoding = PlyEncoding::LittleEndian;
    } else if (word == "binary_big_endian") {
      header_.encoding = PlyEncoding::BigEndian;
    } else {
      scanner_.fail(ErrorCode::BadFile, "the format is ascii, binary_little_endian or binary_big_endian");
    }
    if (scanner_.word() != "1.0") scanner_.fail(ErrorCode::BadFile, "the format version is 1.0");
    has_format_ = true;
  }

  void element() {
    PlyElement element;
    element.name = std::string(required_word("element name"));
    const std::int64_t count = scanner_.integer("element count");
    if (count < 0) scanner_.fail(ErrorCode::BadFile, "an element count is 0 or more");
    element.count = static_cast<std::uint64_t>(count);
    header_.elements.push_back(std::move(element));
  }

  void property() {
    if (header_.elements.empty()) scanner_.fail(ErrorCode::BadFile, "a property comes after its element");
    PlyProperty property{};
    std::string_view first = required_word("property type");
    if (first == "list") {
      property.count_type = type(required_word("count type"));
      first = required_word("list type");
    }
    property.type = type(first);
    property.name = std::string(required_word("property name"));
    if (property.is_list() && !is_integer(*property.count_type)) {
      scanner_.fail(ErrorCode::BadFile, "the count of a list has an integer type");
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  std::string_view required_word(const char* what) {
    const std::string_view word = scanner_.word();
    if (word.empty()) scanner_.fail_missing(what);
    return word;
  }

  PlyType type(std::string_view name) {
    for (const TypeName& known : kTypeNames) {
      if (name == known.name) return known.type;
    }
    scanner_.fail(ErrorCode::BadFile, "unknown property type " + in_quotes(name));
  }

  Scanner scanner_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

std::size_t byte_size(PlyType type) {
  switch (type) {
    case PlyType::Int8:
    case PlyType::Uint8:
      return 1;
    case PlyType::Int16:
    case PlyType::Uint16:
      return 2;
    case PlyType::Int32:
    case PlyType::Uint32:
    case PlyType::Float32:
      return 4;
    case PlyType::Int64:
    case PlyType::Uint64:
    case PlyType::Float64:
      break;
  }
  return 8;
}

bool is_integer(PlyType type) { return type != PlyType::Float32 && type != PlyType::Float64; }

std::size_t PlyElement::smallest_row() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) bytes += byte_size(property.count_type.value_or(property.type));
  return bytes;
}

bool PlyElement::has_list() const {
  return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.is_list(); });
}

PlyHeader parse_ply_header(const Source& source) { return HeaderParser(source).parse(); }

}  // namespace batten::io
