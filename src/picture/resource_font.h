// The fonts of the resource folder (common/resources.h), which need no font service.
#pragma once

#include <cairo.h>

namespace vantage::internal::picture {

/// DejaVu Sans, lent for the rest of the process; null where the resource folder has none, or none that can be read.
cairo_font_face_t* resource_font(bool bold);

}  // namespace vantage::internal::picture
