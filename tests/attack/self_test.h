// Whether the judge can fail.
#pragma once

namespace attack {

/// Puts wrong answers to the judge, and prints which of them it let pass. True when none.
bool self_test();

}  // namespace attack
