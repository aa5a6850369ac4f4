// How the axes and the unit of a mesh are written into OBJ, which has no words for them, and read again.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage::internal::io {

struct Axes {
  UpAxis up = UpAxis::z;
  double unit_m = 1;  ///< metres in one unit of the file; > 0, finite

  bool operator==(const Axes&) const = default;
};

/// "vantage axes: y up, unit 0.3048 m": a comment; the number reads back exactly.
std::string axes_text(const Axes& axes);

/// Reads the text of a comment, after its sign of a comment, into `known` if it is ours. Throws AxesProblem for one
/// that is garbled, or a second one that differs.
void read_axes_comment(std::string_view comment, std::optional<Axes>& known);

/// What is wrong with such a comment; whoever reads the file adds where it stands.
struct AxesProblem {
  std::string text;
};

}  // namespace vantage::internal::io
