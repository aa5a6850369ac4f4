#pragma once

namespace attack {

/// That the judge of meshes finds wrong verdicts and witnesses that are elsewhere; says what it does not.
bool mesh_self_test();

}  // namespace attack
