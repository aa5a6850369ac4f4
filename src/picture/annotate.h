// What is written on a picture: title, legend, scale bar, north arrow.
#pragma once

#include <string>
#include <vector>

#include "picture/palette.h"
#include "picture/view.h"
#include "vantage/picture.h"

namespace vantage::internal::picture {

struct LegendEntry {
  enum class Mark { film, solid, line };
  Mark mark = Mark::film;
  Colour colour;
  std::string label, remark;  ///< "hidden by the scene", "63 %"
};

struct Annotation {
  std::string title, subtitle;
  std::vector<LegendEntry> legend;
  double grid_m = 0;               ///< 0: there is none
  bool is_perspective = false;     ///< lengths hold at the target only
  std::vector<std::string> notes;  ///< in lines under the subtitle
  std::string credit;              ///< whom a licence asks to name: above the legend, to the left
};

/// The kinds of cause that bound the volume, with their shares of its area, the target and the boxes.
std::vector<LegendEntry> legend_of(const PictureRequest& request);

/// The room that annotating a picture of this size takes.
Insets insets_of(const Annotation& annotation, int width, int height);

Picture annotated(const Picture& picture, const Annotation& annotation, const View& view);

/// The credit alone, in the lower left corner, of a picture that is not annotated.
Picture credited(const Picture& picture, const std::string& credit);

}  // namespace vantage::internal::picture
