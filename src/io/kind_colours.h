// The colours of kinds of causes in files: those of pictures (src/picture/palette.h).
#pragma once

#include <array>

#include "vantage/volume.h"

namespace vantage::internal::io {

inline constexpr std::array kKinds = {CauseKind::scene, CauseKind::range, CauseKind::target_plane,
                                      CauseKind::navigation, CauseKind::sensor};

/// sRGB, 0 to 255.
struct KindColour {
  int red = 0, green = 0, blue = 0;
  double opacity = 1;
};

/// The range, which is most of the surface, is the most transparent.
constexpr KindColour colour_of(CauseKind kind) {
  switch (kind) {
    case CauseKind::scene:
      return {0, 114, 178, 0.5};
    case CauseKind::range:
      return {230, 159, 0, 0.25};
    case CauseKind::target_plane:
      return {128, 128, 134, 0.6};
    case CauseKind::navigation:
      return {0, 158, 115, 0.4};
    case CauseKind::sensor:
      break;
  }
  return {204, 121, 167, 0.4};
}

}  // namespace vantage::internal::io
