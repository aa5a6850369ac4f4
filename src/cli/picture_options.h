// What `vantage render` is asked for, in words.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "vantage/mission.h"
#include "vantage/picture.h"

namespace vantage::cli {

/// "top"; "oblique", "oblique AZIMUTH" or "oblique AZIMUTH,ELEVATION"; "from X,Y,Z"; in one word, quoted, or in two.
/// Throws Error(input).
PictureView parse_view(const std::vector<std::string>& given);

/// "1600x1200". Throws Error(input) for what is not a size that render_picture takes.
std::array<int, 2> parse_size(const std::string& text);

/// Throws Error(input) unless the name ends in .png and the file can be written.
void check_picture_file(const std::string& file);

/// "range 300 m": what is written under a picture's title. `volume` may be null.
std::string picture_subtitle(const Mission& mission, const Volume* volume);

}  // namespace vantage::cli
