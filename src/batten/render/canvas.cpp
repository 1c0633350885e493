#include "batten/render/canvas.h"

#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "batten/error.h"
#include "batten/render/srgb.h"

namespace batten::render_detail {
namespace {

constexpr const char* kFont = "DejaVu Sans";

cairo_status_t append_bytes(void* out, const unsigned char* bytes, unsigned count) {
  auto& buffer = *static_cast<Buffer<unsigned char>*>(out);
  const std::size_t old = buffer.size();
  buffer.resize(old + count);
  std::memcpy(buffer.data() + old, bytes, count);
  return CAIRO_STATUS_SUCCESS;
}

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct DestroyContext {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};

}  // namespace

Ink ink_of(const Color& color) {
  // The byte that a picture stores for this colour.
  const auto byte = [](float linear) { return static_cast<double>(std::lround(255.0F * encode_srgb(linear))) / 255.0; };
  return {byte(color[0]), byte(color[1]), byte(color[2])};
}

Ink text_ink(const PictureStyle& style) {
  const Color& back = style.background;
  const float luminance = 0.2126F * back[0] + 0.7152F * back[1] + 0.0722F * back[2];
  return luminance > 0.18F ? ink(0x2B2F36) : ink(0xEDEEF0);
}

struct Canvas::Parts {
  int width;
  int height;
  Buffer<unsigned char> file;
  std::unique_ptr<cairo_surface_t, DestroySurface> surface;
  std::unique_ptr<cairo_t, DestroyContext> context;

  Parts(int width_in, int height_in, Kind kind) : width(width_in), height(height_in) {
    const cairo_format_t format = kind == Kind::Clear ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24;
    surface.reset(kind == Kind::Svg ? cairo_svg_surface_create_for_stream(append_bytes, &file, width, height)
                                    : cairo_image_surface_create(format, width, height));
    context.reset(cairo_create(surface.get()));
    check();
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(context.get(), options);
    cairo_font_options_destroy(options);
    cairo_set_line_join(context.get(), CAIRO_LINE_JOIN_ROUND);
  }

  /// Throws the first failure that Cairo recorded; after it, Cairo ignores all drawing.
  void check() const {
    const cairo_status_t status = cairo_status(context.get());
    if (status != CAIRO_STATUS_SUCCESS)
      throw Error(ErrorCode::BadArgument,
                  std::string("the picture cannot be drawn: ") + cairo_status_to_string(status));
  }

  void set(const Ink& ink) const { cairo_set_source_rgba(context.get(), ink.red, ink.green, ink.blue, ink.alpha); }
  void set(const TextStyle& style) const {
    cairo_select_font_face(context.get(), kFont, CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context.get(), style.size);
  }
  void path(const std::vector<Spot>& points) const {
    for (const Spot& point : points) cairo_line_to(context.get(), point.x(), point.y());
  }
};

Canvas::Canvas(int width, int height, Kind kind) : parts_(std::make_unique<Parts>(width, height, kind)) {}

Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;

void Canvas::fill(const Ink& ink) {
  parts_->set(ink);
  cairo_paint(parts_->context.get());
}

void Canvas::rectangle(const Spot& top_left, const Spot& size, const Ink& ink) {
  parts_->set(ink);
  cairo_rectangle(parts_->context.get(), top_left.x(), top_left.y(), size.x(), size.y());
  cairo_fill(parts_->context.get());
}

void Canvas::polygon(const std::vector<Spot>& corners, const Ink& ink) {
  parts_->set(ink);
  parts_->path(corners);
  cairo_close_path(parts_->context.get());
  cairo_fill(parts_->context.get());
}

void Canvas::line(const std::vector<Spot>& points, const Stroke& stroke) {
  parts_->set(stroke.ink);
  cairo_set_line_width(parts_->context.get(), stroke.width);
  cairo_set_dash(parts_->context.get(), &stroke.dash, stroke.dash > 0.0 ? 1 : 0, 0.0);
  parts_->path(points);
  cairo_stroke(parts_->context.get());
}

void Canvas::disc(const Spot& centre, double radius, const Ink& ink) {
  constexpr double kTurn = 6.283185307179586;
  parts_->set(ink);
  cairo_new_path(parts_->context.get());
  cairo_arc(parts_->context.get(), centre.x(), centre.y(), radius, 0.0, kTurn);
  cairo_fill(parts_->context.get());
}

void Canvas::text(const Spot& at, const std::string& words, const TextStyle& style) {
  const double width = text_width(words, style);
  const double share = style.align == Align::Left ? 0.0 : style.align == Align::Centre ? 0.5 : 1.0;
  parts_->set(style.ink);
  cairo_move_to(parts_->context.get(), at.x() - share * width, at.y());
  cairo_show_text(parts_->context.get(), words.c_str());
  cairo_new_path(parts_->context.get());
}

double Canvas::text_width(const std::string& words, const TextStyle& style) const {
  parts_->set(style);
  cairo_text_extents_t extents;
  cairo_text_extents(parts_->context.get(), words.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::paste(const Picture& picture, int left, int top) {
  const bool clear = picture.channels == 4;
  const std::unique_ptr<cairo_surface_t, DestroySurface> image(
      cairo_image_surface_create(clear ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24, picture.width, picture.height));
  unsigned char* data = cairo_image_surface_get_data(image.get());
  if (data == nullptr) throw Error(ErrorCode::BadArgument, "the picture is too large to be put beside another");
  const int stride = cairo_image_surface_get_stride(image.get());
  const unsigned char* in = picture.pixels.data();
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x, in += picture.channels) {
      const std::uint32_t alpha = clear ? in[3] : 255U;
      std::uint32_t pixel = alpha << 24;
      for (int c = 0; c < 3; ++c) pixel |= (in[c] * alpha + 127U) / 255U << (16 - 8 * c);
      std::memcpy(data + static_cast<std::ptrdiff_t>(y) * stride + std::ptrdiff_t{4} * x, &pixel, sizeof pixel);
    }
  }
  cairo_surface_mark_dirty(image.get());
  cairo_set_source_surface(parts_->context.get(), image.get(), left, top);
  cairo_paint(parts_->context.get());
}

Picture Canvas::picture() const {
  parts_->check();
  cairo_surface_flush(parts_->surface.get());
  const unsigned char* data = cairo_image_surface_get_data(parts_->surface.get());
  const int stride = cairo_image_surface_get_stride(parts_->surface.get());
  const bool clear = cairo_image_surface_get_format(parts_->surface.get()) == CAIRO_FORMAT_ARGB32;
  Picture picture;
  picture.width = parts_->width;
  picture.height = parts_->height;
  picture.channels = clear ? 4 : 3;
  picture.pixels.reserve(static_cast<std::size_t>(picture.channels) * static_cast<std::size_t>(picture.width) *
                         static_cast<std::size_t>(picture.height));
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, data + static_cast<std::ptrdiff_t>(y) * stride + std::ptrdiff_t{4} * x, sizeof pixel);
      const std::uint32_t alpha = clear ? pixel >> 24 : 255U;
      for (const int shift : {16, 8, 0}) {
        const std::uint32_t part = pixel >> shift & 255U;
        picture.pixels.push_back(
            static_cast<unsigned char>(alpha > 0 ? std::min(255U, (part * 255U + alpha / 2) / alpha) : 0U));
      }
      if (clear) picture.pixels.push_back(static_cast<unsigned char>(alpha));
    }
  }
  return picture;
}

Buffer<unsigned char> Canvas::svg() {
  parts_->check();
  cairo_surface_finish(parts_->surface.get());
  const cairo_status_t status = cairo_surface_status(parts_->surface.get());
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(ErrorCode::BadArgument,
                std::string("the drawing cannot be written: ") + cairo_status_to_string(status));
  return std::move(parts_->file);
}

}  // namespace batten::render_detail
