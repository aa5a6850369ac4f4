#include "picture/canvas.h"

#include <cstddef>
#include <utility>

#include "picture/resource_font.h"
#include "vantage/error.h"

namespace vantage::internal::picture {
namespace {

constexpr const char* kBuiltInFont = "@cairo:";

cairo_surface_t* surface_of(const Picture& picture) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height);
  if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) return surface;
  unsigned char* rows = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  const std::uint8_t* from = picture.rgba.data();
  for (int row = 0; row < picture.height; ++row) {
    auto* to = reinterpret_cast<std::uint32_t*>(rows + std::ptrdiff_t{row} * stride);
    for (int column = 0; column < picture.width; ++column, from += 4) {
      to[column] = std::uint32_t{from[0]} << 16 | std::uint32_t{from[1]} << 8 | std::uint32_t{from[2]};
    }
  }
  cairo_surface_mark_dirty(surface);
  return surface;
}

/// Length in bytes of the UTF-8 character that begins at `at`, 0 where none does.
std::size_t character_length(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : (first >= 0xE0 ? 3 : 2);
  if (first < 0xC2 || first > 0xF4) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0U) != 0x80) return 0;
  }
  const unsigned second = byte(at + 1);  // overlong forms, surrogates, beyond U+10FFFF
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F)) return 0;
  if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F)) return 0;
  return length;
}

struct PngStream {
  std::string bytes;
  core::ProgressBridge* bridge;

  static cairo_status_t append(void* to, const unsigned char* more, unsigned length) {
    auto* const stream = static_cast<PngStream*>(to);
    stream->bytes.append(reinterpret_cast<const char*>(more), length);
    return core::ProgressBridge::ask(stream->bridge, 0) ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
  }
};

}  // namespace

std::string printable(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    const auto first = static_cast<unsigned char>(text[at]);
    if (length == 0) {
      result += '?';
    } else if (length == 1 && (first < 0x20 || first == 0x7F)) {
      result += ' ';
    } else {
      result.append(text, at, length);
    }
    at += length == 0 ? 1 : length;
  }
  return result;
}

Canvas::Canvas(const Picture& picture) : surface_(surface_of(picture)) { start(); }

Canvas::Canvas(int width, int height) : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)) {
  start();
  set_colour(kPaper);
  cairo_paint(cairo());
}

void Canvas::start() {
  check(cairo_surface_status(surface_.get()), "making an image");
  cairo_.reset(cairo_create(surface_.get()));
  check(cairo_status(cairo()), "beginning to draw");
  // A machine without fonts shows when one is asked for: tried on a context that may be spoilt.
  const std::unique_ptr<cairo_t, CairoEnd> trial(cairo_create(surface_.get()));
  cairo_select_font_face(trial.get(), family_, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_text_extents_t extents{};
  cairo_text_extents(trial.get(), "m", &extents);
  if (cairo_status(trial.get()) != CAIRO_STATUS_SUCCESS || extents.x_advance <= 0) family_ = kBuiltInFont;

  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(cairo(), options);
  cairo_font_options_destroy(options);
}

void Canvas::check(cairo_status_t status, const char* doing) const {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw Error(ErrorCode::internal_defect,
              std::string("Cairo failed in ") + doing + ": " + cairo_status_to_string(status), "", "");
}

void Canvas::set_colour(Colour colour, double opacity) {
  cairo_set_source_rgba(cairo(), colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, opacity);
}

void Canvas::set_font(double size, bool bold) {
  if (cairo_font_face_t* const face = resource_font(bold)) {
    cairo_set_font_face(cairo(), face);
  } else {
    cairo_select_font_face(cairo(), family_, CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  }
  cairo_set_font_size(cairo(), size);
}

double Canvas::width_of(const std::string& text) const {
  cairo_text_extents_t extents{};
  cairo_text_extents(cairo(), printable(text).c_str(), &extents);
  return extents.x_advance;
}

void Canvas::show(const std::string& text, double x, double baseline) {
  cairo_move_to(cairo(), x, baseline);
  cairo_show_text(cairo(), printable(text).c_str());
  cairo_new_path(cairo());
  check(cairo_status(cairo()), "writing text");
}

void Canvas::show_with_halo(const std::string& text, double x, double baseline) {
  cairo_font_extents_t extents{};
  cairo_font_extents(cairo(), &extents);
  cairo_save(cairo());
  cairo_move_to(cairo(), x, baseline);
  cairo_text_path(cairo(), printable(text).c_str());
  cairo_set_line_join(cairo(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(cairo(), 0.2 * extents.height);
  set_colour(kPaper, 0.8);
  cairo_stroke(cairo());
  cairo_restore(cairo());
  show(text, x, baseline);
}

std::string Canvas::fitted(const std::string& text, double width) const {
  std::string fits = printable(text);
  if (width_of(fits) <= width) return fits;
  const std::string ellipsis = "\u2026";
  while (!fits.empty() && width_of(fits + ellipsis) > width) {
    while (fits.size() > 1 && (static_cast<unsigned char>(fits.back()) & 0xC0U) == 0x80) fits.pop_back();
    fits.pop_back();
  }
  return fits + ellipsis;
}

void Canvas::fill_rectangle(double x, double y, double width, double height) {
  cairo_rectangle(cairo(), x, y, width, height);
  cairo_fill(cairo());
}

void Canvas::place(const Picture& picture, double x, double y) {
  const std::unique_ptr<cairo_surface_t, SurfaceEnd> image(surface_of(picture));
  check(cairo_surface_status(image.get()), "placing a picture");
  cairo_set_source_surface(cairo(), image.get(), x, y);
  cairo_rectangle(cairo(), x, y, picture.width, picture.height);
  cairo_fill(cairo());
  check(cairo_status(cairo()), "placing a picture");
}

Picture Canvas::picture() const {
  cairo_surface_flush(surface_.get());
  Picture picture{cairo_image_surface_get_width(surface_.get()), cairo_image_surface_get_height(surface_.get()), {}};
  picture.rgba.resize(std::size_t{4} * static_cast<std::size_t>(picture.width) *
                      static_cast<std::size_t>(picture.height));
  const unsigned char* rows = cairo_image_surface_get_data(surface_.get());
  const int stride = cairo_image_surface_get_stride(surface_.get());
  std::uint8_t* to = picture.rgba.data();
  for (int row = 0; row < picture.height; ++row) {
    const auto* from = reinterpret_cast<const std::uint32_t*>(rows + std::ptrdiff_t{row} * stride);
    for (int column = 0; column < picture.width; ++column, to += 4) {
      to[0] = static_cast<std::uint8_t>(from[column] >> 16 & 0xFF);
      to[1] = static_cast<std::uint8_t>(from[column] >> 8 & 0xFF);
      to[2] = static_cast<std::uint8_t>(from[column] & 0xFF);
      to[3] = 255;
    }
  }
  return picture;
}

std::string Canvas::png(const core::ProgressReporter& progress) const {
  core::ProgressBridge bridge(progress);
  PngStream stream{{}, &bridge};
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface_.get(), PngStream::append, &stream);
  bridge.rethrow();
  check(status, "writing PNG");
  return std::move(stream.bytes);
}

}  // namespace vantage::internal::picture
