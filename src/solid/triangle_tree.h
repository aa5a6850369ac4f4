// The hierarchy of core/, under the names of this module.
#pragma once

#include "core/triangle_tree.h"

namespace vantage::internal::solid {

using core::triangle_box;
using core::TriangleTree;

}  // namespace vantage::internal::solid
