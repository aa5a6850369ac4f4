// A failing case, made as small as it stays failing.
#pragma once

#include <functional>

#include "judge.h"

namespace attack {

/// Judges a case in a process of its own.
Judgement judge_isolated(const Case& c, const JudgeOptions& options, unsigned seconds);

/// Takes away triangles, limits, parts and corners of the target while the judge still finds it, a third as deep at
/// least. At most `tries` judgements.
Case minimise(const Case& c, const Finding& finding, const JudgeOptions& options, unsigned seconds, int tries);

}  // namespace attack
