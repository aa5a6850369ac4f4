// Points in, answers out, as comma-separated text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vantage/query.h"

namespace vantage::cli {

/// Points from text: a row each, separated by commas, semicolons or blanks (the first row with content decides). If the
/// first row holds words, it is a header and the columns called x, y and z are taken (in any order, upper or lower
/// case); else the first three columns. Empty rows and rows that begin with # are skipped; fields may stand in double
/// quotes. `file` is for messages. Throws Error(input) with the line for a row that lacks a column or holds no finite
/// number in one, and for a header without x, y, z.
std::vector<Vec3> parse_points(std::string_view text, const std::string& file);

/// The header and a row per point: x,y,z,inside,margin_m,blocked_by,out_of_range,behind_target,outside_of. Names in one
/// field are joined with ';'.
std::string answers_text(const std::vector<Vec3>& points, const std::vector<PointAnswer>& answers);

}  // namespace vantage::cli
