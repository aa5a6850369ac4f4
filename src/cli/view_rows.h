// Positions and what is seen from them, as rows of tables for people.
#pragma once

#include <string>

#include "cli/text_table.h"
#include "vantage/standpoints.h"

namespace vantage::cli {

/// Where it lies: scene frame, on the earth, heights, as far as they are known.
void add_place(TextTable& table, const ViewDescription& view);

/// How to aim, and how well the target is seen.
void add_sight(TextTable& table, const ViewDescription& view);

/// "3.42 cm", "0.16 mm": the size of a pixel.
std::string pixel_text(double pixel_m);

}  // namespace vantage::cli
