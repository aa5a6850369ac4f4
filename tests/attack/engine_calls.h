// The only file of the attack that calls what is attacked.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "case.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace attack {

/// What the engine made of a case.
struct Answer {
  std::vector<vantage::Volume> parts;  ///< of each part of the target, before cuts
  vantage::Volume volume;              ///< of all of it, cut to the limits

  bool thrown = false;
  bool defect = false;  ///< an exception that may not be: Error(internal), or none of ours
  std::string refusal;  ///< "pierced", "under the ground", "target", "navigation", "other"
  std::string message;
};

Answer ask_engine(const Case& c);

/// Of part `part`, without the limits. Nothing where it throws; `message` says what.
std::optional<std::vector<vantage::PointAnswer>> ask_query(const Case& c, std::size_t part,
                                                           const std::vector<vantage::Vec3>& points,
                                                           std::string& message);

/// The target with its corners in the other order must give the same volume, and comparing the two must work. What is
/// wrong, or empty.
std::string reversed_differs(const Case& c, const vantage::Volume& volume);

/// Writes scene.obj and mission.yaml (one a part) into the folder, which is made.
void write_case(const Case& c, const std::filesystem::path& folder);

/// Reads a mission with a mesh scene.
Case read_case(const std::filesystem::path& mission);

}  // namespace attack
