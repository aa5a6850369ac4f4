// Which triangles are round each vertex, of a mesh that is being changed.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::core {

/// Holds indices only: who changes a triangle tells so. Building: linear time. A change: linear in the vertex's
/// triangles.
class Stars {
 public:
  Stars(const std::vector<Triangle>& triangles, std::size_t vertices);

  /// The triangles round a vertex, in the order in which they came. Valid until that vertex's star is changed.
  std::span<const std::uint32_t> of(std::uint32_t vertex) const;

  void add(std::uint32_t vertex, std::uint32_t triangle) { editable(vertex).push_back(triangle); }
  void remove(std::uint32_t vertex, std::uint32_t triangle);
  void clear(std::uint32_t vertex) { editable(vertex).clear(); }
  void add_vertex() { changed_.push_back(kNone); }
  /// The last one, which must have no triangles.
  void remove_vertex() { changed_.pop_back(); }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::vector<std::uint32_t>& editable(std::uint32_t vertex);

  std::vector<std::uint32_t> first_, triangles_;   // as built
  std::vector<std::uint32_t> changed_;             // per vertex: its place in stars_, kNone while it is as built
  std::vector<std::vector<std::uint32_t>> stars_;  // of the vertices that have changed
};

}  // namespace vantage::internal::core
