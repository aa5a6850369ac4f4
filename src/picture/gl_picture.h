// Draws a list by OpenGL 4.5, off screen.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress_reporter.h"
#include "depth/gl_context.h"
#include "picture/draw_list.h"
#include "picture/view.h"

namespace vantage::internal::picture {

/// Rows from the top, RGB, 8 bits a channel: the mean of several frames, each moved by a part of a pixel and lit from
/// directions of its own. Throws DeviceFailure; Error(cancelled). Takes about 70 bytes of the device's memory for each
/// pixel, and the list's size.
std::vector<std::uint8_t> draw_picture(const depth::GlContext& context, const DrawList& list, const View& view,
                                       const core::ProgressReporter& progress);

}  // namespace vantage::internal::picture
