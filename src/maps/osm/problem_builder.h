// What is wrong with one object, as one Problem.
#pragma once

#include <cstddef>
#include <string>

#include "maps/osm/extract.h"

namespace vantage::internal::osm {

/// Gathers sentences about an object. The first kind counts: name causes before what follows from them.
class ProblemBuilder {
 public:
  void add(Problem::Kind kind, const std::string& sentence) {
    if (what_.empty()) kind_ = kind;
    what_.append(what_.empty() ? "" : "; ").append(sentence);
  }

  /// "3 of 12 nodes are not in the file"; nothing for a count of 0.
  void add_share(Problem::Kind kind, std::size_t count, std::size_t total, const std::string& things,
                 const std::string& problem) {
    if (count == 0) return;
    const std::string numbers = std::to_string(count).append(" of ").append(std::to_string(total));
    add(kind, numbers + " " + things + (count == 1 ? " is " : " are ") + problem);
  }

  bool empty() const { return what_.empty(); }
  Problem build(ObjectId object, const Tags& tags, bool lost) const { return {object, kind_, what_, lost, tags}; }

 private:
  Problem::Kind kind_ = Problem::Kind::missing_nodes;
  std::string what_;
};

}  // namespace vantage::internal::osm
