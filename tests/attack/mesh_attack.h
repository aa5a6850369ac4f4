// Attacks the proof with meshes of which it is known what they are: docs/verification.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace attack {

struct MeshAttackOptions {
  std::uint64_t seed = 1;
  std::size_t first = 0, count = 0;
  int jobs = 2;
  unsigned seconds = 60;      ///< processor time of one mesh
  std::filesystem::path out;  ///< what fails is written there, made small; empty: nowhere
  int written = 3;            ///< of each sort
  bool told = false;          ///< print each mesh
};

/// The exit code.
int attack_with_meshes(const MeshAttackOptions& options);

}  // namespace attack
