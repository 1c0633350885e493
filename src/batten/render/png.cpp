#include <png.h>

#include <cstdio>
#include <cstring>

#include "batten/error.h"
#include "batten/output.h"
#include "batten/render/picture.h"

namespace batten {
namespace {

void append_bytes(png_structp png, png_bytep bytes, png_size_t count) {
  auto& out = *static_cast<Buffer<unsigned char>*>(png_get_io_ptr(png));
  const std::size_t old = out.size();
  out.resize(old + count);
  std::memcpy(out.data() + old, bytes, count);
}

void flush_nothing(png_structp /*png*/) {}

/// libpng reports errors with longjmp, so no object with a destructor may exist in this function.
bool encode(png_structp png, png_infop info, const Picture& picture, Buffer<unsigned char>& out) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &out, append_bytes, flush_nothing);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height), 8,
               picture.channels == 4 ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  // Level 4 with one filter takes a third of the default's time, and files are a few percent larger.
  png_set_compression_level(png, 4);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
  png_write_info(png, info);
  const std::size_t stride = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.channels);
  for (int y = 0; y < picture.height; ++y)
    png_write_row(png, picture.pixels.data() + stride * static_cast<std::size_t>(y));
  png_write_end(png, info);
  return true;
}

}  // namespace

void check_picture(const Picture& picture) {
  const bool sized = picture.width > 0 && picture.height > 0 && (picture.channels == 3 || picture.channels == 4) &&
                     picture.pixels.size() == static_cast<std::size_t>(picture.channels) *
                                                  static_cast<std::size_t>(picture.width) *
                                                  static_cast<std::size_t>(picture.height);
  if (!sized)
    throw Error(ErrorCode::BadShape,
                "a picture needs width * height * channels bytes, both sizes above 0, and 3 or 4 channels");
}

Buffer<unsigned char> encode_png(const Picture& picture) {
  check_picture(picture);
  Buffer<unsigned char> out;
  out.reserve(picture.pixels.size() / 4);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  const bool written = info != nullptr && encode(png, info, picture, out);
  png_destroy_write_struct(&png, &info);
  if (!written) throw Error(ErrorCode::BadShape, "libpng refuses a picture of this size; ask for a smaller one");
  return out;
}

void write_png(const std::string& path, const Picture& picture) { write_bytes(path, encode_png(picture)); }

}  // namespace batten
