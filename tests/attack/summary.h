// What many judgements add up to.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "judge.h"

namespace attack {

class Summary {
 public:
  void add(const Case& c, const Judgement& judgement);

  /// Tables by scale, by what is in the scene, and by finding.
  std::string text() const;
  std::size_t wrong() const { return wrong_; }  ///< scenes

 private:
  struct Row {
    std::size_t scenes = 0, computed = 0, empty = 0, refused = 0, wrong = 0, touching = 0, query = 0;
    std::size_t viewpoints = 0, proved = 0, smaller = 0, unproved = 0, measured = 0, losing = 0;
    double lost = 0, most_lost = 0;

    void add(const Judgement& judgement);
    std::string text(const std::string& name) const;
  };

  std::map<double, Row> by_scale_;
  std::map<std::string, Row> by_thing_, by_target_;
  std::map<std::string, std::size_t> statuses_;
  std::map<FindingKind, std::size_t> classes_;
  Row all_;
  std::size_t wrong_ = 0;
};

}  // namespace attack
