// A picture that Cairo draws on.
#pragma once

#include <cairo.h>

#include <memory>
#include <string>

#include "core/progress_reporter.h"
#include "picture/palette.h"
#include "vantage/picture.h"

namespace vantage::internal::picture {

/// Text and simple shapes. Lengths are pixels, right and down from the upper left corner. Fonts: DejaVu Sans of the
/// resource folder, else of the machine; without it whatever sans the machine has, and without any, what Cairo brings
/// along. Throws Error(internal) when Cairo fails.
class Canvas {
 public:
  explicit Canvas(const Picture& picture);
  Canvas(int width, int height);  ///< of plain paper

  cairo_t* cairo() const { return cairo_.get(); }

  void set_colour(Colour colour, double opacity = 1);
  void set_font(double size, bool bold = false);
  /// The width of the text as show() would write it.
  double width_of(const std::string& text) const;
  /// Writes from (x, baseline); what is not UTF-8 appears as '?'.
  void show(const std::string& text, double x, double baseline);
  /// The same on a ground that may be busy: paper shines round the letters.
  void show_with_halo(const std::string& text, double x, double baseline);
  /// The text, cut short with an ellipsis where it is wider than `width`.
  std::string fitted(const std::string& text, double width) const;
  void fill_rectangle(double x, double y, double width, double height);
  void place(const Picture& picture, double x, double y);

  Picture picture() const;
  /// Throws Error(cancelled).
  std::string png(const core::ProgressReporter& progress = {}) const;

 private:
  struct SurfaceEnd {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  };
  struct CairoEnd {
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  };
  void check(cairo_status_t status, const char* doing) const;
  void start();

  std::unique_ptr<cairo_surface_t, SurfaceEnd> surface_;
  std::unique_ptr<cairo_t, CairoEnd> cairo_;
  const char* family_ = "DejaVu Sans";
};

/// `text` without control characters, and with '?' for what is not UTF-8.
std::string printable(const std::string& text);

}  // namespace vantage::internal::picture
