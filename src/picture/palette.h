// The colours of pictures. Causes: M. Okabe and K. Ito, Color Universal Design, 2008: told apart by readers with any
// kind of colour vision, and by their lightness in grey print.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "vantage/volume.h"

namespace vantage::internal::picture {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

inline constexpr Colour kPaper{255, 255, 255};
inline constexpr Colour kInk{32, 36, 44};
inline constexpr Colour kFaintInk{104, 110, 120};
inline constexpr Colour kBuilding{236, 235, 232};
inline constexpr Colour kGround{250, 250, 249};
inline constexpr Colour kGridLine{176, 182, 190};
inline constexpr Colour kTarget{196, 18, 48};
inline constexpr Colour kTargetOutline{120, 0, 24};
inline constexpr Colour kCrease{24, 38, 66};
inline constexpr Colour kBox{0, 110, 80};
inline constexpr Colour kKeepOut{120, 60, 20};
inline constexpr Colour kPlainVolume{0, 114, 178};
inline constexpr Colour kPath{32, 36, 44};
inline constexpr Colour kMarkedPath{240, 160, 0};

/// The colours of PictureRequest::solids, in turn.
inline constexpr std::array<Colour, 4> kSolids{Colour{0, 114, 178}, Colour{0, 158, 115}, Colour{204, 121, 167},
                                               Colour{86, 180, 233}};

/// The colours of PictureRequest::marks, in turn.
inline constexpr std::array<Colour, 2> kMarks{Colour{232, 0, 0}, Colour{240, 200, 0}};

constexpr Colour colour_of(CauseKind kind) {
  switch (kind) {
    case CauseKind::scene:
      return {0, 114, 178};
    case CauseKind::range:
      return {230, 159, 0};
    case CauseKind::target_plane:
      return {128, 128, 134};
    case CauseKind::navigation:
      return {0, 158, 115};
    case CauseKind::sensor:
      return {204, 121, 167};
  }
  return kPlainVolume;
}

/// Red in the lowest byte, as OpenGL reads four normalized bytes on a little-endian machine; `opacity` from 0 to 1.
inline std::uint32_t packed(Colour colour, double opacity = 1) {
  const auto alpha = static_cast<std::uint32_t>(std::lround(opacity * 255));
  return std::uint32_t{colour.red} | std::uint32_t{colour.green} << 8 | std::uint32_t{colour.blue} << 16 | alpha << 24;
}

}  // namespace vantage::internal::picture
