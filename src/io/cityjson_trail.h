// Where in a CityJSON file the reader is, for messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/mesh_source.h"
#include "io/text_cursor.h"
#include "vantage/error.h"

namespace vantage::internal::io::cityjson {

/// "city.json, CityObject "b1", geometry 0, shell 0, surface 3": pushed and popped on the way.
class Trail {
 public:
  explicit Trail(const MeshSource& source) : source_(source) {}

  /// A step for as long as it lives.
  class Step {
   public:
    Step(Trail& trail, const char* what, std::size_t index) : trail_(trail) { trail_.steps_.emplace_back(what, index); }
    ~Step() { trail_.steps_.pop_back(); }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    Trail& trail_;
  };

  /// The line of a text sequence that is read; 0 for none.
  void set_line(std::uint64_t line) { line_ = line; }
  void set_object(std::string id) { object_ = std::move(id); }
  const std::string& object() const { return object_; }

  [[noreturn]] void fail(std::string problem, std::string fix = kGarbled) const {
    fail_as(ErrorCode::mesh_syntax, std::move(problem), std::move(fix));
  }
  [[noreturn]] void fail_as(ErrorCode code, std::string problem, std::string fix = kGarbled) const {
    std::string where = source_.file().string();
    if (line_ > 0) where += ", line " + std::to_string(line_);
    if (!object_.empty()) where += ", CityObject " + shown_word(object_);
    for (const auto& [what, index] : steps_) where.append(", ").append(what).append(" ").append(std::to_string(index));
    throw Error(code, "not a valid CityJSON file: " + std::move(problem), where, std::move(fix));
  }

  static constexpr const char* kGarbled = "export the file again, and check it with cjval or val3dity";

 private:
  const MeshSource& source_;
  std::uint64_t line_ = 0;
  std::string object_;
  std::vector<std::pair<const char*, std::size_t>> steps_;
};

}  // namespace vantage::internal::io::cityjson
