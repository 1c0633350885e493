/// Meshes in gzip files.
#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

/// The checksum of gzip files (RFC 1952), bit by bit.
std::uint32_t checksum(const std::string& text) {
  std::uint32_t sum = 0xffffffffU;
  for (const char c : text) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~sum;
}

std::string number(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
  return text;
}

/// A gzip file that stores the text as it is, in blocks of at most 65535 bytes (RFC 1951, 3.2.4).
std::string stored(const std::string& text) {
  std::string file("\x1f\x8b\x08\0\0\0\0\0\0\3", 10);
  for (std::size_t at = 0; at == 0 || at < text.size(); at += 65535) {
    const std::string block = text.substr(at, 65535);
    const auto size = static_cast<std::uint32_t>(block.size());
    file += static_cast<char>(at + 65535 >= text.size() ? 1 : 0);
    file += number(size, 2) + number(~size, 2) + block;
  }
  return file + number(checksum(text), 4) + number(static_cast<std::uint32_t>(text.size()), 4);
}

const char* const kObjText = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

Mesh read_bytes(const std::string& name, const std::string& bytes) {
  const TemporaryFolder folder;
  make_file(folder.path(name), bytes);
  return read_mesh(folder.path(name));
}

TEST(Gzip, TheTypeStandsBeforeTheExtension) {
  const Mesh expected = parse(io::read_obj, kObjText);
  expect_same_mesh(expected, read_bytes("m.obj.gz", stored(kObjText)));
  expect_same_mesh(expected, read_bytes("M.OBJ.GZ", stored(kObjText)));
  expect_same_mesh(expected, read_bytes("m.obj", stored(kObjText)));
  expect_same_mesh(expected, read_bytes("m.obj.gz", kObjText));  // some browsers unpack while they download
  expect_same_mesh(expected, read_bytes("m.obj.gz", stored("\xEF\xBB\xBF" + std::string(kObjText))));
  expect_error([] { read_bytes("m.gz", stored(kObjText)); }, ErrorCode::UnknownFormat, "no file type");
  expect_error([] { read_bytes("m.abc.gz", stored(kObjText)); }, ErrorCode::UnknownFormat, "'abc'");
}

TEST(Gzip, WhatGzipPackedIsRead) {
  // python3: gzip.compress(b"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\n" + 6 * b"f 1 2 3\n", 9, mtime=0)
  const std::string packed(
      "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\x2b\x53\x30\x00\x41\xae\x32\x05\x43\x28\x6d\x04\xa5\x8d"
      "\xc1\x74\x1a\x50\xdc\x48\xc1\x98\x68\x1a\x00\x11\xe6\x80\xb0\x50\x00\x00\x00",
      43);
  const Mesh mesh = read_bytes("m.obj.gz", packed);
  EXPECT_EQ(mesh.points.col(0), (Eigen::Vector4d(0, 1, 2, 3)));
  EXPECT_EQ(mesh.face_count(), 6);
}

TEST(Gzip, ALargeFileAndSeveralInARowAreOneText) {
  std::string text(kObjText);
  for (int i = 0; i < 300000; ++i) text += "f 3 2 1\n";
  EXPECT_EQ(read_bytes("m.obj.gz", stored(text)).face_count(), 300001);
  const std::string parts = stored(text.substr(0, 13)) + stored(text.substr(13));
  EXPECT_EQ(read_bytes("m.obj.gz", parts).face_count(), 300001);
  EXPECT_EQ(read_bytes("m.obj.gz", parts + std::string(512, '\0')).face_count(), 300001);
}

TEST(Gzip, EveryCutAndEveryWrongByteIsAnError) {
  const std::string whole = stored(kObjText);
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_EQ(error_of([&] { read_bytes("m.obj.gz", whole.substr(0, size)); })->code(), ErrorCode::BadFile) << size;
  }
  // The header's bytes 4 to 9 hold a date and a system, which nobody checks.
  for (std::size_t at = 10; at < whole.size(); ++at) {
    std::string broken = whole;
    broken[at] = static_cast<char>(broken[at] ^ 0x55);
    EXPECT_EQ(error_of([&] { read_bytes("m.obj.gz", broken); })->code(), ErrorCode::BadFile) << at;
  }
  expect_error([&] { read_bytes("m.obj.gz", whole.substr(0, 40)); }, ErrorCode::BadFile, "is cut short");
  expect_error([&] { read_bytes("m.obj.gz", whole + "x"); }, ErrorCode::BadFile, "other bytes follow");
  expect_error([&] { read_bytes("m.obj.gz", stored("")); }, ErrorCode::BadFile, "the packed file is empty");
}

TEST(Gzip, NothingIsWrittenUnderThatName) {
  const TemporaryFolder folder;
  const Mesh mesh = parse(io::read_obj, kObjText);
  expect_error([&] { write_mesh(folder.path("m.obj.gz"), mesh); }, ErrorCode::UnknownFormat, "only read");
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
}  // namespace batten::io_tests
