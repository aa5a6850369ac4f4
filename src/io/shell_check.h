// Whether the polygons of a shell close it.
#pragma once

#include <cstdint>
#include <vector>

namespace vantage::internal::io {

/// Collects the rings of a shell's polygons, borders and holes alike, as they turn in the file.
class ShellCheck {
 public:
  void begin() { edges_.clear(); }
  /// An edge from one vertex to the next; vertices at one place have one number.
  void add_edge(std::uint32_t from, std::uint32_t to) {
    const bool forward = from < to;
    edges_.push_back({forward ? from : to, forward ? to : from, forward ? 1 : -1});
  }

  enum class Result { closed, open, misoriented };
  /// `open`: some edge has an odd number of rings. `misoriented`: none has, but some is run more often one way.
  Result result();
  /// The ends of the edges with an odd number of rings, as the last result found them: what is missing lies between.
  const std::vector<std::uint32_t>& open_ends() const { return open_ends_; }

 private:
  struct Edge {
    std::uint32_t low, high;
    int direction;
  };
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> open_ends_;
};

}  // namespace vantage::internal::io
