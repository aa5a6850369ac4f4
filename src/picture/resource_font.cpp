#include "picture/resource_font.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <cairo-ft.h>

#include <filesystem>
#include <map>
#include <mutex>

#include "common/resources.h"

namespace vantage::internal::picture {
namespace {

/// Faces are never given back: Cairo keeps them in caches of its own. Cairo lets one thread at a time use a face;
/// making them is guarded here.
class Fonts {
 public:
  cairo_font_face_t* find(const std::filesystem::path& file) {
    const std::scoped_lock lock(mutex_);
    const auto known = faces_.find(file);
    if (known != faces_.end()) return known->second;
    cairo_font_face_t* const face = open(file);
    if (face) faces_.emplace(file, face);  // a file that is not there may come
    return face;
  }

 private:
  cairo_font_face_t* open(const std::filesystem::path& file) {
    if (!library_ && FT_Init_FreeType(&library_) != 0) return nullptr;
    FT_Face face = nullptr;
    if (FT_New_Face(library_, file.c_str(), 0, &face) != 0) return nullptr;
    cairo_font_face_t* const font = cairo_ft_font_face_create_for_ft_face(face, 0);
    return cairo_font_face_status(font) == CAIRO_STATUS_SUCCESS ? font : nullptr;
  }

  std::mutex mutex_;
  FT_Library library_ = nullptr;
  std::map<std::filesystem::path, cairo_font_face_t*> faces_;
};

}  // namespace

cairo_font_face_t* resource_font(bool bold) {
  static Fonts& fonts = *new Fonts;  // used until the process ends
  const std::filesystem::path folder = resource_folder();
  if (folder.empty()) return nullptr;
  return fonts.find(folder / "fonts" / (bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf"));
}

}  // namespace vantage::internal::picture
