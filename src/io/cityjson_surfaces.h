// Surfaces of CityJSON geometries: polygons with holes become triangles, shells are looked at for what is wrong.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/cityjson_trail.h"
#include "io/mesh_builder.h"
#include "io/shell_check.h"

namespace vantage::internal::io::cityjson {

/// What is wrong in a way that a soup may be, counted, with the object where it is first.
class Finding {
 public:
  void add(const std::string& object) {
    if (count_++ == 0) first_ = object;
  }
  /// "3 solids are not closed (the first is of "b1")"; appended to `notes` unless there is none.
  void note(std::vector<std::string>& notes, const char* one, const char* many, const std::string& more = "") const;

 private:
  std::size_t count_ = 0;
  std::string first_;
};

class SurfaceBuilder {
 public:
  SurfaceBuilder(MeshBuilder& builder, const Trail& trail, const core::ReadLimits& limits)
      : builder_(builder), trail_(trail), limits_(limits) {}

  /// The surfaces between these two bound a solid from outside, or a cavity of it.
  void begin_shell(bool is_cavity);
  void end_shell();

  /// Adds a polygon to the mesh. `rings`: the border, then the holes, as vertices of the mesh; corners that repeat the
  /// one before are taken as one. Throws Error(input) for more corners than the limits allow.
  void add(std::vector<std::vector<std::uint32_t>>& rings);

  void add_notes(std::vector<std::string>& notes) const;

  /// What of an object is not built as it stands.
  struct Fault {
    std::string object;  ///< its id
    std::string what, reason, instead = {};
    Box box;
    Mesh holder = {};  ///< holds it; where it is empty, and `instead` is given, the object does as it is built
  };
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  void tell_open();
  void check_shell(const std::vector<std::vector<std::uint32_t>>& rings);

  MeshBuilder& builder_;
  const Trail& trail_;
  const core::ReadLimits& limits_;

  bool in_shell_ = false, is_cavity_ = false;
  ShellCheck shell_;
  std::optional<Vec3> about_;  // a point of the shell
  double volume_ = 0;          // six times what the shell encloses

  Finding open_, misoriented_, inside_out_, holes_outside_;
  std::vector<Fault> faults_;
};

}  // namespace vantage::internal::io::cityjson
