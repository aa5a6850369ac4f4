// Whether the verdicts on a mesh hold.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mesh_case.h"

namespace attack {

struct MeshFinding {
  std::string what;  ///< "unsound: sun", "false witness: range", "defect", "crash", "hang"
  Vec3 place = Vec3::Zero();
  std::string detail;
};

struct MeshJudgement {
  std::string status = {};  ///< "proved", "wrong", "not proved", "refused", "unsuitable"
  std::string kind = {};
  std::vector<std::pair<std::string, std::string>> claims = {};  ///< with their verdicts
  std::vector<MeshFinding> findings = {};                        ///< one of each sort
  std::size_t inside = 0;                                        ///< points of the volume that were looked from
  std::size_t witnesses = 0;                                     ///< that were checked
};

/// `verdicts`: what prove() says, or somebody else.
MeshJudgement judge_mesh(const MeshCase& c, const Verdicts& verdicts);

/// Whether the point is surely in the volume, deeper than what is left out, and surely breaks the claim, by more than
/// what is allowed.
bool refutes(const MeshCase& c, const Verdicts& verdicts, const std::string& claim, const Vec3& point);

}  // namespace attack
